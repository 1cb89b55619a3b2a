// What the options of a bake may be: the same rules in the same words on the command line, where
// they are called "--max-side", and in manifests, where they are "maxSide".
#pragma once

#include "assets/mesh_asset.h"

#include <span>
#include <string>

namespace penumbra {

struct OptionRule {
    enum class Value { Number, Whole, Even, GridSide, Flag };
    const char* flag;   // on the command line
    const char* member; // of "options" in a manifest
    Value value;
    double min = 0, max = 0; // of numbers
};

inline constexpr OptionRule kShellsRule{"--shells", "shells", OptionRule::Value::Whole, 2,
                                        kMaxFieldShells};
inline constexpr OptionRule kMaxSideRule{"--max-side", "maxSide", OptionRule::Value::GridSide, 3,
                                         kMaxFieldSide};
inline constexpr OptionRule kDirectionsRule{"--directions", "directions", OptionRule::Value::Even,
                                            2, 65536};
inline constexpr OptionRule kThresholdRule{"--threshold", "threshold", OptionRule::Value::Number, 0,
                                           1};
inline constexpr OptionRule kTargetErrorRule{"--target-error", "targetError",
                                             OptionRule::Value::Number, 1e-4, 1};
inline constexpr OptionRule kLodsRule{"--lods", "lods", OptionRule::Value::Whole, 0, kMaxMeshLods};
// On the command line there is "--no-field", which is `"field": false`.
inline constexpr OptionRule kFieldRule{"--no-field", "field", OptionRule::Value::Flag};
inline constexpr OptionRule kVerifyRule{"--verify", "verify", OptionRule::Value::Flag};

// "not a whole number from 2 to 128"; empty where `value` is allowed.
std::string whyNot(const OptionRule& rule, double value);

// Two options that cannot both be given; a flag is given where there is no field.
struct OptionConflict {
    const OptionRule *option, *other;
    const char* why; // "which it picks itself"
};
std::span<const OptionConflict> optionConflicts();

// "--verify beside --no-field, which leaves no field to measure; leave out one". `name` says where.
std::string conflictText(const OptionConflict& conflict, const char* OptionRule::*name);

} // namespace penumbra
