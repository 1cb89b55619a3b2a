// What a sweep over lights says: a file for programs, a picture and a table for people.
#pragma once

#include "demo/image/image.h"
#include "demo/sweep/sweep_lights.h"

#include <span>

namespace penumbra {

// Comma-separated, one row per light, angle and method, with a head:
//   light             cap or sphere
//   halfAngleDegrees  under which the middle of the scene sees the light
//   method            exact, literal, order4, rays16 …, truth
//   receivers         compared
//   meanUnshadowed    radiance without occlusion, W/(m² sr); the errors are relative to it
//   rmseRelative, biasRelative, maxRelative
//   nsPerReceiver     nanoseconds on all cores; empty where nothing was timed
std::string sweepCsv(std::span<const SweepRow> rows);

// A row per light and angle: errors, times, and what `exact` costs against rays.
std::string sweepTable(std::span<const SweepRow> rows);

// Errors over angles, a plot per kind of light; then what rays of the same error cost. At least two
// angles.
Image8 drawSweep(std::span<const SweepRow> rows);

// How many rays have the error of `exact`, between the measured counts and beyond them along the
// line through the nearest two (in logarithms), at least one, and how long they would
// take: evenly between counts, below the least in proportion to it.
struct EqualRays {
    double rays = 0;
    double nanoseconds = 0; // per receiver
};
EqualRays raysOfEqualError(std::span<const SweepRow> rows, const std::string& light,
                           float halfAngle);

// sweep_lights.csv and sweep_lights.png.
Result<void> writeSweep(std::span<const SweepRow> rows, const std::filesystem::path& out);

} // namespace penumbra
