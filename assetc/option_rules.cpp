#include "assetc/option_rules.h"

#include <cmath>
#include <fmt/format.h>

namespace penumbra {

std::string whyNot(const OptionRule& rule, double value)
{
    using Value = OptionRule::Value;
    const bool whole = value == std::floor(value); // in range, below 2^53
    const bool inRange = value >= rule.min && value <= rule.max;
    const auto bits = static_cast<std::uint64_t>(inRange ? value : 0);
    bool allowed = inRange && (whole || rule.value == Value::Number);
    const char* kind = "number";
    if (rule.value == Value::Whole) {
        kind = "whole number";
    } else if (rule.value == Value::Even) {
        kind = "even number";
        allowed = allowed && bits % 2 == 0;
    } else if (rule.value == Value::GridSide) {
        kind = "number 2^k + 1";
        allowed = allowed && ((bits - 1) & (bits - 2)) == 0;
    }
    return allowed ? std::string()
                   : fmt::format("not a{} {} from {} to {}", *kind == 'e' ? "n" : "", kind,
                                 rule.min, rule.max);
}

std::span<const OptionConflict> optionConflicts()
{
    static constexpr const char* kPicked = "which it picks itself";
    static constexpr const char* kNoField = "which leaves no field to measure";
    static constexpr OptionConflict kConflicts[] = {
        {&kTargetErrorRule, &kShellsRule, kPicked},     {&kTargetErrorRule, &kMaxSideRule, kPicked},
        {&kTargetErrorRule, &kDirectionsRule, kPicked}, {&kTargetErrorRule, &kFieldRule, kNoField},
        {&kVerifyRule, &kFieldRule, kNoField},
    };
    return kConflicts;
}

std::string conflictText(const OptionConflict& conflict, const char* OptionRule::*name)
{
    const bool isFalse =
        name == &OptionRule::member && conflict.other->value == OptionRule::Value::Flag;
    return fmt::format("{} beside {}{}, {}; leave out one", conflict.option->*name,
                       conflict.other->*name, isFalse ? ": false" : "", conflict.why);
}

} // namespace penumbra
