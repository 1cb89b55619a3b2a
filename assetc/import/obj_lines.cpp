#include "assetc/import/obj_lines.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

namespace penumbra {

namespace {

constexpr std::int64_t kAbsent = std::numeric_limits<std::int64_t>::min();

// Indices of vertex, texture coordinate and normal.
using Corner = std::array<std::int64_t, 3>;

// "3", "3/1", "3//2", "-1/-1/-1". False: something else.
bool parseCorner(std::string_view word, Corner& corner)
{
    corner.fill(kAbsent);
    const char *at = word.data(), *end = at + word.size();
    for (std::size_t i = 0; i < corner.size(); ++i) {
        if (i != 1 || at == end || *at != '/') {
            const auto [last, error] = std::from_chars(at, end, corner[i]);
            constexpr std::int64_t kMost = std::numeric_limits<int>::max();
            if (error != std::errc{} || corner[i] > kMost || corner[i] < -kMost)
                return false;
            at = last;
        }
        if (at == end)
            return true;
        if (*at++ != '/')
            return false;
    }
    return false;
}

bool isFiniteNumber(std::string_view word)
{
    if (word.starts_with('+') && !word.starts_with("+-"))
        word.remove_prefix(1);
    double value = 0;
    const auto [last, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc{} && last == word.data() + word.size() && std::isfinite(value);
}

class LineReader {
public:
    Result<ObjLines> read(std::string_view text);

private:
    // The place of an index that is larger than any so far: whether it exists is known at the end.
    struct Largest {
        std::int64_t index = 0;
        std::size_t line = 0;
        std::string_view word;
    };

    std::string_view nextWord()
    {
        m_line.remove_prefix(std::min(m_line.find_first_not_of(" \t"), m_line.size()));
        const std::string_view word = m_line.substr(0, m_line.find_first_of(" \t"));
        m_line.remove_prefix(word.size());
        return word;
    }
    [[nodiscard]] Error refuse(const std::string& what) const
    {
        return {fmt::format("line {}: {}", m_number, what)};
    }
    Result<void> readVertex();
    Result<void> readCorners(std::size_t least);
    Result<void> checkCorner(std::string_view word);
    [[nodiscard]] Result<void> checkLargest(const Largest& largest, const char* what,
                                            std::size_t count) const;

    ObjLines m_lines;
    std::string_view m_line; // what is left of it
    std::size_t m_number = 0;
    Largest m_vertex, m_normal;
};

Result<void> LineReader::readVertex()
{
    ++m_lines.vertices;
    for (int i = 1; i <= 3; ++i)
        if (const std::string_view word = nextWord(); !isFiniteNumber(word))
            return refuse(fmt::format("a vertex takes three finite numbers, number {} is \"{}\"", i,
                                      word.substr(0, 40)));
    return {};
}

Result<void> LineReader::checkCorner(std::string_view word)
{
    const std::string_view shown = word.substr(0, 40);
    Corner corner;
    if (!parseCorner(word, corner))
        return refuse(fmt::format("corner \"{}\" is not an index", shown));
    if (std::find(corner.begin(), corner.end(), 0) != corner.end())
        return refuse(fmt::format("corner \"{}\" has the index 0; OBJ counts from 1", shown));
    const auto check = [&](std::int64_t index, std::size_t count, const char* what,
                           Largest& largest) -> Result<void> {
        if (index != kAbsent && -index > static_cast<std::int64_t>(count))
            return refuse(fmt::format("corner \"{}\" counts {} {} back, and there are {} before it",
                                      shown, -index, what, count));
        if (index > largest.index)
            largest = {index, m_number, shown};
        return {};
    };
    // A texture coordinate that does not exist costs no shape.
    if (auto vertex = check(corner[0], m_lines.vertices, "vertices", m_vertex); !vertex)
        return vertex;
    return check(corner[2], m_lines.normals, "normals", m_normal);
}

// Of a face, a line or points.
Result<void> LineReader::readCorners(std::size_t least)
{
    std::size_t corners = 0;
    for (std::string_view word = nextWord(); !word.empty() && !word.starts_with('#');
         word = nextWord(), ++corners)
        if (auto checked = checkCorner(word); !checked)
            return checked;
    if (corners < least)
        return refuse(fmt::format(
            "a face with {} corners; the file may be cut off, export it again", corners));
    return {};
}

Result<void> LineReader::checkLargest(const Largest& largest, const char* what,
                                      std::size_t count) const
{
    if (largest.index <= static_cast<std::int64_t>(count))
        return {};
    return Error{
        fmt::format("line {}: corner \"{}\" is {} {}, and the file has {}; export it again",
                    largest.line, largest.word, what, largest.index, count)};
}

Result<ObjLines> LineReader::read(std::string_view text)
{
    if (text.find('\0') != std::string_view::npos)
        return Error{"a zero byte: not a text file; export it again"};
    while (!text.empty()) {
        ++m_number;
        const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
        m_line = text.substr(0, end);
        text.remove_prefix(end);
        const bool isOpen = text.empty();
        text.remove_prefix(text.starts_with("\r\n") ? 2 : std::min<std::size_t>(text.size(), 1));
        const std::string_view keyword = nextWord();
        const bool face = keyword == "f";
        if ((face || keyword == "v") && m_line.ends_with('\\'))
            return refuse("continues on the next, which is not supported; join the two");
        Result<void> checked;
        if (face || keyword == "l" || keyword == "p") {
            ++(face ? m_lines.faces : keyword == "l" ? m_lines.lines : m_lines.points);
            checked = readCorners(face ? 3 : 0);
            m_lines.openFace = face && isOpen ? m_number : 0;
        } else if (keyword == "v") {
            checked = readVertex();
        } else if (keyword == "vt") {
            ++m_lines.texcoords;
        } else if (keyword == "vn") {
            ++m_lines.normals;
        } else if (keyword == "surf") {
            ++m_lines.surfaces;
        } else if (keyword == "usemtl") {
            if (const std::string_view name = nextWord(); !name.empty())
                m_lines.materialLine.emplace(name, m_number);
        }
        if (!checked)
            return checked.error();
    }
    if (auto checked = checkLargest(m_vertex, "vertex", m_lines.vertices); !checked)
        return checked.error();
    if (auto checked = checkLargest(m_normal, "normal", m_lines.normals); !checked)
        return checked.error();
    return std::move(m_lines);
}

} // namespace

Result<ObjLines> readObjLines(std::string_view text)
{
    return LineReader().read(text);
}

} // namespace penumbra
