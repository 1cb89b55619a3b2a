#include "runtime/ecs/json_text.h"

#include "runtime/ecs/scene_file.h"

#include <algorithm>
#include <fmt/format.h>

namespace penumbra::ecs {

namespace {

// Builds the document while the parser reads, so that the first thing wrong stops it.
class Builder : public nlohmann::json_sax<Json> {
public:
    Json document;
    std::string error;
    size_t errorByte = 0; // of a syntax error, from 1

    bool null() override { return add(nullptr); }
    bool boolean(bool value) override { return add(value); }
    bool number_integer(number_integer_t value) override { return add(value); }
    bool number_unsigned(number_unsigned_t value) override { return add(value); }
    bool number_float(number_float_t value, const string_t&) override { return add(value); }
    bool string(string_t& value) override { return add(std::move(value)); }
    bool binary(binary_t&) override { return false; } // not in text
    bool start_object(size_t) override { return open(Json::object()); }
    bool start_array(size_t) override { return open(Json::array()); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool key(string_t& name) override
    {
        Json& object = *m_open.back();
        if (object.contains(name))
            return refuse(fmt::format("has the member \"{}\" twice; remove one", name));
        if (object.size() >= kMaxJsonMembers)
            return refuse(fmt::format("has more than {} members; split it", kMaxJsonMembers));
        m_key = std::move(name);
        return true;
    }
    bool parse_error(size_t position, const std::string&,
                     const nlohmann::detail::exception& problem) override
    {
        errorByte = position;
        error = problem.id == 406 ? "a number too large for a double" : "not valid JSON";
        return false;
    }

private:
    Json* add(Json&& value, Json*& place)
    {
        if (m_open.empty())
            place = &(document = std::move(value));
        else if (m_open.back()->is_array())
            place = &m_open.back()->emplace_back(std::move(value));
        else
            place = &((*m_open.back())[m_key] = std::move(value));
        return place;
    }
    bool add(Json value)
    {
        Json* place = nullptr;
        add(std::move(value), place);
        return true;
    }
    bool open(Json value)
    {
        if (m_open.size() >= kMaxJsonNesting)
            return refuse(
                fmt::format("is nested deeper than {} levels; flatten it", kMaxJsonNesting));
        Json* place = nullptr;
        m_open.push_back(add(std::move(value), place));
        return true;
    }
    bool close()
    {
        m_open.pop_back();
        return true;
    }
    bool refuse(const std::string& what)
    {
        std::string place;
        for (size_t i = 0; i + 1 < m_open.size(); ++i) {
            const Json& level = *m_open[i];
            place += level.is_array() ? fmt::format("/{}", level.size() - 1)
                                      : "/" + std::prev(level.end()).key();
        }
        error = (place.empty() ? "/" : place) + " " + what;
        return false;
    }

    std::vector<Json*> m_open; // the last child of its parent each, so that pointers stay
    std::string m_key;
};

} // namespace

std::string JsonPlace::text() const
{
    if (parent == nullptr)
        return {};
    if (element)
        return parent->text() + fmt::format("/{}", index);
    std::string escaped;
    for (const char c : key.substr(0, 100))
        escaped += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
    return parent->text() + "/" + escaped;
}

Result<Json> parseSceneJson(std::string_view text)
{
    if (text.size() > kMaxSceneBytes)
        return Error{fmt::format("a scene of {} bytes, more than {}; split it", text.size(),
                                 kMaxSceneBytes)};
    Builder builder;
    if (Json::sax_parse(text, &builder))
        return std::move(builder.document);
    if (builder.errorByte == 0)
        return Error{builder.error};
    const std::string_view before = text.substr(0, std::min(builder.errorByte - 1, text.size()));
    return Error{fmt::format("{} at line {}, column {}; correct it there", builder.error,
                             std::count(before.begin(), before.end(), '\n') + 1,
                             before.size() - (before.rfind('\n') + 1) + 1)};
}

} // namespace penumbra::ecs
