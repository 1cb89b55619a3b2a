#include "assets/json_reader.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace penumbra {

namespace {

// Nesting of brackets outside strings. Text that is not JSON gives some number; the parser refuses
// it later.
int nestingDepth(std::string_view text)
{
    int depth = 0;
    int deepest = 0;
    bool inString = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (inString) {
            if (c == '\\')
                ++i;
            else if (c == '"')
                inString = false;
        } else if (c == '"') {
            inString = true;
        } else if (c == '{' || c == '[') {
            deepest = std::max(deepest, ++depth);
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
    return deepest;
}

// Only after parsing failed, so that the usual way costs no exception.
std::string syntaxPlace(std::string_view text)
{
    try {
        const nlohmann::json ignored = nlohmann::json::parse(text);
    } catch (const nlohmann::json::parse_error& error) {
        const std::string_view before = text.substr(0, error.byte == 0 ? 0 : error.byte - 1);
        const auto line = std::count(before.begin(), before.end(), '\n') + 1;
        return fmt::format(" at line {}, column {}", line,
                           before.size() - (before.rfind('\n') + 1) + 1);
    } catch (const nlohmann::json::exception&) {
    }
    return {};
}

// At most 40 bytes, escaped: no control characters on a terminal.
std::string quotedText(const std::string& text)
{
    constexpr std::size_t kMost = 40;
    const nlohmann::json value = text.size() > kMost ? text.substr(0, kMost - 3) + "..." : text;
    return value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

// Listens to the parser, which itself keeps the last of two members of a name.
class DoubledMembers {
public:
    explicit DoubledMembers(JsonProblems& problems) : m_problems(problems) {}

    bool operator()(int, nlohmann::json::parse_event_t event, const nlohmann::json& value)
    {
        using Event = nlohmann::json::parse_event_t;
        if (event == Event::key) {
            m_open.back().key = value.get_ref<const std::string&>();
            if (!m_open.back().keys.insert(m_open.back().key).second)
                refuse();
        } else if (event == Event::object_end || event == Event::array_end) {
            m_open.pop_back();
        } else {
            if (!m_open.empty())
                ++m_open.back().index;
            if (event != Event::value)
                m_open.push_back({event == Event::array_start, {}, {}, 0});
        }
        return true;
    }

private:
    struct Level {
        bool isArray;
        std::set<std::string> keys;
        std::string key;
        std::size_t index; // of an array, behind the element that is read
    };

    void refuse() const
    {
        std::string place;
        for (std::size_t i = 0; i + 1 < m_open.size(); ++i)
            if (m_open[i].isArray)
                place += fmt::format("[{}]", m_open[i].index - 1);
            else if (const std::string key = quotedText(m_open[i].key); key.size() > 2)
                place += fmt::format("{}{}", place.empty() ? "" : ".",
                                     std::string_view(key).substr(1, key.size() - 2));
        m_problems.push_back(
            {fmt::format("{}{}has {} twice; delete one", place, place.empty() ? "" : " ",
                         quotedText(m_open.back().key))});
    }

    std::vector<Level> m_open;
    JsonProblems& m_problems;
};

Result<nlohmann::json> parse(std::string_view text, std::size_t maxBytes,
                             const nlohmann::json::parser_callback_t& listener)
{
    if (text.size() > maxBytes)
        return Error{fmt::format("JSON of {} bytes, more than {}", text.size(), maxBytes)};
    if (nestingDepth(text) > kMaxJsonDepth)
        return Error{fmt::format("JSON nested deeper than {} levels", kMaxJsonDepth)};
    nlohmann::json document = nlohmann::json::parse(text, listener, false);
    if (document.is_discarded())
        return Error{"not valid JSON" + syntaxPlace(text)};
    if (!document.is_object())
        return Error{"JSON whose root is not an object"};
    return document;
}

} // namespace

Result<nlohmann::json> parseJson(std::string_view text, std::size_t maxBytes)
{
    return parse(text, maxBytes, nullptr);
}

Result<nlohmann::json> parseJson(std::string_view text, std::size_t maxBytes,
                                 JsonProblems& problems)
{
    return parse(text, maxBytes, DoubledMembers(problems));
}

JsonReader JsonReader::member(const char* key) const
{
    const std::string place = m_place.empty() ? key : m_place + "." + key;
    if (!m_value)
        return {nullptr, place, *m_problems};
    const auto found = m_value->is_object() ? m_value->find(key) : m_value->end();
    if (found == m_value->end()) {
        refuse(fmt::format("has no \"{}\"", key));
        return {nullptr, place, *m_problems};
    }
    return {&*found, place, *m_problems};
}

JsonReader JsonReader::element(std::size_t index) const
{
    const std::string place = fmt::format("{}[{}]", m_place, index);
    if (!m_value)
        return {nullptr, place, *m_problems};
    if (!m_value->is_array() || index >= m_value->size()) {
        refuse(fmt::format("has no element {}", index));
        return {nullptr, place, *m_problems};
    }
    return {&(*m_value)[index], place, *m_problems};
}

bool JsonReader::has(const char* key) const
{
    return m_value && m_value->is_object() && m_value->contains(key);
}

std::size_t JsonReader::length(std::size_t max) const
{
    if (!m_value)
        return 0;
    if (!m_value->is_array() || m_value->size() > max) {
        refuse(fmt::format("is {}, not an array of at most {}", quoted(), max));
        return 0;
    }
    return m_value->size();
}

std::uint64_t JsonReader::asCount(std::uint64_t max, std::uint64_t min) const
{
    if (!m_value)
        return 0;
    const std::uint64_t value = m_value->is_number_unsigned() ? m_value->get<std::uint64_t>() : 0;
    if (!m_value->is_number_unsigned() || value < min || value > max) {
        refuse(fmt::format("is {}, not a whole number from {} to {}", quoted(), min, max));
        return 0;
    }
    return value;
}

float JsonReader::asNumber(float min, float max) const
{
    if (!m_value)
        return 0;
    const double value = m_value->is_number() ? m_value->get<double>() : std::nan("");
    if (!(value >= min && value <= max)) {
        refuse(fmt::format("is {}, not a number from {} to {}", quoted(), min, max));
        return 0;
    }
    return static_cast<float>(value);
}

double JsonReader::anyNumber() const
{
    return m_value && m_value->is_number() ? m_value->get<double>() : HUGE_VAL;
}

std::string JsonReader::asText() const
{
    if (!m_value)
        return {};
    if (!m_value->is_string()) {
        refuse(fmt::format("is {}, not text", quoted()));
        return {};
    }
    return m_value->get<std::string>();
}

bool JsonReader::asFlag() const
{
    if (!m_value)
        return false;
    if (!m_value->is_boolean()) {
        refuse(fmt::format("is {}, not true or false", quoted()));
        return false;
    }
    return m_value->get<bool>();
}

void JsonReader::refuseOthers(const std::vector<std::string_view>& known) const
{
    if (!m_value)
        return;
    if (!m_value->is_object()) {
        refuse(fmt::format("is {}, not an object", quoted()));
        return;
    }
    for (const auto& [key, value] : m_value->items())
        if (std::find(known.begin(), known.end(), key) == known.end())
            refuse(fmt::format("has the unknown member {}; known: {}", quotedText(key),
                               known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", "))));
}

std::uint64_t JsonReader::count(const char* key, std::uint64_t max) const
{
    return member(key).asCount(max);
}

float JsonReader::number(const char* key, float min, float max) const
{
    return member(key).asNumber(min, max);
}

std::string JsonReader::text(const char* key) const
{
    return member(key).asText();
}

bool JsonReader::flag(const char* key) const
{
    return member(key).asFlag();
}

void JsonReader::checkVersion(std::uint64_t version) const
{
    if (!has("version"))
        refuse(fmt::format("has no \"version\"; add \"version\": {}", version));
    else if (const JsonReader stated = member("version"); *stated.m_value != version)
        stated.refuse(fmt::format("is {}, this program reads {}", stated.quoted(), version));
}

std::string JsonReader::quoted() const
{
    if (!m_value)
        return "missing";
    if (m_value->is_array())
        return fmt::format("an array of {}", m_value->size());
    if (m_value->is_object())
        return "an object";
    return m_value->is_string() ? quotedText(m_value->get_ref<const std::string&>())
                                : m_value->dump();
}

void JsonReader::refuse(const std::string& what) const
{
    m_problems->push_back({m_place.empty() ? what : m_place + " " + what});
}

} // namespace penumbra
