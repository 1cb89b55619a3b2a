// Reading of untrusted JSON. parseJson bounds size and depth before the parser sees the text.
// JsonReader walks the document and collects problems, each with its place, so that callers read
// everything and check once (a root with an empty place gives places like "assets[3].name"):
//   JsonProblems problems;
//   const JsonReader root(document, "json", problems);
//   const std::uint64_t count = root.member("accessors").element(3).count("count", kMax);
//   if (!problems.empty()) return problems.front();
// A value that is not as asked reads as zero, which is safe to size and index with; what lies below
// a missing value is not reported again.
#pragma once

#include "runtime/result.h"

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

// Deeper nesting than any real glTF has; readers that recurse are safe at this depth.
constexpr int kMaxJsonDepth = 64;

// Parses UTF-8 text of at most `maxBytes`, nested at most kMaxJsonDepth deep; the root is an
// object. An error of syntax names line and column.
Result<nlohmann::json> parseJson(std::string_view text, std::size_t maxBytes);

using JsonProblems = std::vector<Error>;

// The same of a file that people write: a member that is there twice is a problem with its place,
// and reads as its last value.
Result<nlohmann::json> parseJson(std::string_view text, std::size_t maxBytes,
                                 JsonProblems& problems);

class JsonReader {
public:
    JsonReader(const nlohmann::json& value, std::string place, JsonProblems& problems)
        : JsonReader(&value, std::move(place), problems)
    {}

    // A required member of an object, or element of an array.
    [[nodiscard]] JsonReader member(const char* key) const;
    [[nodiscard]] JsonReader element(std::size_t index) const;
    [[nodiscard]] bool has(const char* key) const;
    [[nodiscard]] bool isText() const { return m_value && m_value->is_string(); }
    [[nodiscard]] bool isNull() const { return m_value && m_value->is_null(); }
    // Infinite where it is no number.
    [[nodiscard]] double anyNumber() const;
    [[nodiscard]] bool isArrayOf(std::size_t count) const
    {
        return m_value && m_value->is_array() && m_value->size() == count;
    }

    // A reader of nothing: has no members, reads as zero, reports nothing.
    [[nodiscard]] JsonReader missing() const { return {nullptr, m_place, *m_problems}; }

    // The value itself: array length, whole number min..max, finite number in [min, max], text.
    [[nodiscard]] std::size_t length(std::size_t max) const;
    [[nodiscard]] std::uint64_t asCount(std::uint64_t max, std::uint64_t min = 0) const;
    [[nodiscard]] float asNumber(float min, float max) const;
    [[nodiscard]] std::string asText() const;
    [[nodiscard]] bool asFlag() const;

    // The same of a required member.
    [[nodiscard]] std::uint64_t count(const char* key, std::uint64_t max) const;
    [[nodiscard]] float number(const char* key, float min, float max) const;
    [[nodiscard]] std::string text(const char* key) const;
    [[nodiscard]] bool flag(const char* key) const; // true or false

    // Records a problem for each member that is none of `known`, or if this is no object. For files
    // that people write: there an unknown member is a slip of the pen.
    void refuseOthers(const std::vector<std::string_view>& known) const;

    // For files that people write: a problem unless the member "version" is `version`.
    void checkVersion(std::uint64_t version) const;

    // The value as a message quotes it: at most 40 bytes of text, "an array of 3" or "an object".
    [[nodiscard]] std::string quoted() const;

    // Records a problem at this place.
    void refuse(const std::string& what) const;

private:
    JsonReader(const nlohmann::json* value, std::string place, JsonProblems& problems)
        : m_value(value), m_place(std::move(place)), m_problems(&problems)
    {}

    const nlohmann::json* m_value; // null where missing
    std::string m_place;
    JsonProblems* m_problems;
};

} // namespace penumbra
