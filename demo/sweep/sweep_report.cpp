#include "demo/sweep/sweep_report.h"

#include "demo/image/plot.h"
#include "runtime/file.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace penumbra {

namespace {

constexpr std::uint32_t kPanelWidth = 760, kPanelHeight = 640;

struct Style {
    const char* name;
    Color color;
    bool dashed;
};

// Colours that colour-blind eyes tell apart (Okabe and Ito, 2002).
Style styleOf(const std::string& method)
{
    if (method == "exact")
        return {"fields, kernel exact", {213, 94, 0}, false};
    if (method == "literal")
        return {"fields, kernel literal", {230, 159, 0}, false};
    if (method == "order4")
        return {"order-4 light, ray-traced", {120, 120, 120}, true};
    if (method == "rays16")
        return {"16 rays", {86, 180, 233}, false};
    if (method == "rays64")
        return {"64 rays", {0, 114, 178}, false};
    if (method == "rays256")
        return {"256 rays", {0, 60, 110}, false};
    return {method == "truth" ? "noise of the truth" : nullptr, {180, 180, 180}, true};
}

// Angles of a kind of light, in order of the rows.
std::vector<float> anglesOf(std::span<const SweepRow> rows, const std::string& light)
{
    std::vector<float> angles;
    for (const SweepRow& row : rows)
        if (row.light == light &&
            std::find(angles.begin(), angles.end(), row.halfAngle) == angles.end())
            angles.push_back(row.halfAngle);
    return angles;
}

std::vector<std::string> methodsOf(std::span<const SweepRow> rows)
{
    std::vector<std::string> methods;
    for (const SweepRow& row : rows)
        if (std::find(methods.begin(), methods.end(), row.method) == methods.end())
            methods.push_back(row.method);
    return methods;
}

const SweepRow* find(std::span<const SweepRow> rows, const std::string& light, float halfAngle,
                     const std::string& method)
{
    for (const SweepRow& row : rows)
        if (row.light == light && row.halfAngle == halfAngle && row.method == method)
            return &row;
    return nullptr;
}

} // namespace

std::string sweepCsv(std::span<const SweepRow> rows)
{
    std::string csv = "light,halfAngleDegrees,method,receivers,meanUnshadowed,rmseRelative,"
                      "biasRelative,maxRelative,nsPerReceiver\n";
    for (const SweepRow& row : rows) {
        const double mean = row.errors.meanUnshadowed > 0 ? row.errors.meanUnshadowed : 1;
        csv +=
            fmt::format("{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{}\n", row.light, row.halfAngle,
                        row.method, row.receivers, row.errors.meanUnshadowed,
                        row.errors.rmseRelative, row.errors.bias / mean, row.errors.maxAbs / mean,
                        row.nanoseconds > 0 ? fmt::format("{:.4g}", row.nanoseconds) : "");
    }
    return csv;
}

EqualRays raysOfEqualError(std::span<const SweepRow> rows, const std::string& light,
                           float halfAngle)
{
    struct Point {
        double rays, error; // logarithms
        double nanoseconds;
    };
    std::vector<Point> points;
    for (const SweepRow& row : rows)
        if (row.light == light && row.halfAngle == halfAngle && row.method.starts_with("rays"))
            points.push_back({std::log(std::stod(row.method.substr(4))),
                              std::log(row.errors.rmseRelative), row.nanoseconds});
    const SweepRow* exact = find(rows, light, halfAngle, "exact");
    if (exact == nullptr || points.size() < 2)
        return {};
    const double error = std::log(exact->errors.rmseRelative);
    std::size_t i = 0; // the line from point i to the next
    while (i + 2 < points.size() && points[i + 1].error > error)
        ++i;
    const Point &a = points[i], &b = points[i + 1];
    const double slope = (b.rays - a.rays) / (b.error - a.error);
    const double rays = std::max(1.0, std::exp(a.rays + slope * (error - a.error)));
    // Time grows evenly with the rays; below the least count in proportion, which flatters them.
    const double first = std::exp(a.rays), second = std::exp(b.rays);
    if (i == 0 && rays < first)
        return {rays, a.nanoseconds * rays / first};
    return {rays,
            a.nanoseconds + (b.nanoseconds - a.nanoseconds) * (rays - first) / (second - first)};
}

namespace {

// What rays of the error of exact cost, over what exact does; 0: not timed.
double gainOf(std::span<const SweepRow> rows, const std::string& light, float halfAngle)
{
    const SweepRow* exact = find(rows, light, halfAngle, "exact");
    return exact != nullptr && exact->nanoseconds > 0
               ? raysOfEqualError(rows, light, halfAngle).nanoseconds / exact->nanoseconds
               : 0;
}

Plot gainPlot(std::span<const SweepRow> rows)
{
    Plot plot{.title = "what rays of the same error cost",
              .xLabel = "half-angle of the light, degrees",
              .yLabel = "time of rays / time of exact"};
    for (const std::string light : {"cap", "sphere"}) {
        const std::vector<float> angles = anglesOf(rows, light);
        if (angles.size() > plot.xTicks.size())
            plot.xTicks = angles;
        PlotCurve curve{light == "cap" ? "cap of the sky" : "sphere",
                        light == "cap" ? Color{213, 94, 0} : Color{0, 114, 178},
                        false,
                        {}};
        for (const float angle : angles)
            curve.points.emplace_back(angle, gainOf(rows, light, angle));
        plot.curves.push_back(std::move(curve));
    }
    plot.curves.push_back({"equal: fields win above", {60, 60, 60}, true, {}});
    for (const float angle : plot.xTicks)
        plot.curves.back().points.emplace_back(angle, 1);
    return plot;
}

} // namespace

std::string sweepTable(std::span<const SweepRow> rows)
{
    std::string table = "rmse over the mean unshadowed irradiance, and ns per receiver; equal: "
                        "rays with the error of exact, and their time over its time\n";
    const std::vector<std::string> methods = methodsOf(rows);
    for (const std::string light : {"cap", "sphere"}) {
        if (anglesOf(rows, light).empty())
            continue;
        table += fmt::format("{:<6} {:>5}", light, "angle");
        for (const std::string& method : methods)
            table += fmt::format(" {:>8}", method);
        table += " |";
        for (const std::string& method : methods)
            if (method != "truth" && method != "order4")
                table += fmt::format(" {:>8}", method);
        table += fmt::format(" | {:>7} {:>6}\n", "equal", "time");
        for (const float angle : anglesOf(rows, light)) {
            table += fmt::format("{:<6} {:>5}", "", angle);
            std::string times;
            for (const std::string& method : methods) {
                const SweepRow* row = find(rows, light, angle, method);
                if (row == nullptr)
                    continue;
                table += fmt::format(" {:>8.4f}", row->errors.rmseRelative);
                if (row->nanoseconds > 0)
                    times += fmt::format(" {:>8.0f}", row->nanoseconds);
            }
            const EqualRays equal = raysOfEqualError(rows, light, angle);
            table += fmt::format(" |{} | {:>7.1f} {:>6.2f}\n", times, equal.rays,
                                 gainOf(rows, light, angle));
        }
    }
    return table;
}

Image8 drawSweep(std::span<const SweepRow> rows)
{
    std::vector<Image8> panels;
    for (const std::string light : {"cap", "sphere"}) {
        const std::vector<float> angles = anglesOf(rows, light);
        if (angles.empty())
            continue;
        Plot plot;
        plot.title = light == "cap" ? "a cap of the sky, 45 degrees high"
                                    : "a sphere 4 m away, 60 degrees high";
        plot.xLabel = "half-angle of the light, degrees";
        plot.yLabel = "rmse / mean unshadowed irradiance";
        plot.xTicks = angles;
        for (const std::string& method : methodsOf(rows)) {
            const Style style = styleOf(method);
            PlotCurve curve{
                style.name != nullptr ? style.name : method, style.color, style.dashed, {}};
            for (const float angle : angles)
                if (const SweepRow* row = find(rows, light, angle, method))
                    curve.points.emplace_back(angle, row->errors.rmseRelative);
            plot.curves.push_back(std::move(curve));
        }
        plot.yRange = {1e-4f, 1};
        panels.push_back(drawPlot(plot, kPanelWidth, kPanelHeight));
    }
    panels.push_back(drawPlot(gainPlot(rows), kPanelWidth, kPanelHeight));
    return sideBySide(panels, 8);
}

Result<void> writeSweep(std::span<const SweepRow> rows, const std::filesystem::path& out)
{
    Result<void> done = writeFile(out / "sweep_lights.csv", sweepCsv(rows));
    return done ? writePng(out / "sweep_lights.png", drawSweep(rows)) : done;
}

} // namespace penumbra
