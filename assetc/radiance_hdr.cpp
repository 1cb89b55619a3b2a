// Radiance RGBE pictures (Ward, "Real Pixels", Graphics Gems II, 1991). Read here and not with
// stb_image, whose reader never returns from a run of length 0, which is what it sees at the end of
// a cut file.
#include "assetc/environment.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>

namespace penumbra {

namespace {

struct Rgbe {
    std::uint8_t r, g, b, e;
};

// Radiance's own decoder takes the middle of the quantisation step, (m + 0.5); other readers,
// stb_image and OpenCV among them, take m, which keeps black black. So do we.
vec3 radiance(Rgbe p)
{
    const float scale = p.e == 0 ? 0.0f : std::ldexp(1.0f, p.e - 136);
    return vec3(p.r, p.g, p.b) * scale;
}

class Reader {
public:
    explicit Reader(std::span<const std::byte> bytes) : m_bytes(bytes) {}

    [[nodiscard]] std::size_t left() const { return m_bytes.size() - m_at; }
    [[nodiscard]] bool done() const { return left() == 0; }

    // One byte; after the end 0, and `failed` says so.
    std::uint8_t byte()
    {
        if (done()) {
            failed = true;
            return 0;
        }
        return static_cast<std::uint8_t>(m_bytes[m_at++]);
    }

    std::string_view line()
    {
        const char* begin = reinterpret_cast<const char*>(m_bytes.data()) + m_at;
        const void* end = std::memchr(begin, '\n', left());
        if (end == nullptr) {
            failed = true;
            return {};
        }
        const std::string_view text(begin, static_cast<const char*>(end) - begin);
        m_at += text.size() + 1;
        return text;
    }

    Rgbe pixel()
    {
        const std::uint8_t r = byte(), g = byte(), b = byte(), e = byte();
        return {r, g, b, e};
    }

    bool failed = false;

private:
    std::span<const std::byte> m_bytes;
    std::size_t m_at = 0;
};

// Lines EXPOSURE=number say what the pixels were multiplied by, one after the other. False: a
// number that cannot be. A line's end may be a carriage return too.
bool takeExposure(std::string_view line, double& exposure)
{
    constexpr std::string_view kKey = "EXPOSURE=";
    if (!line.starts_with(kKey))
        return true;
    line.remove_prefix(std::min(line.find_first_not_of(" \t", kKey.size()), line.size()));
    double factor = 0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), factor);
    exposure *= factor;
    return error == std::errc{} && exposure >= 1e-6 && exposure <= 1e6;
}

bool parseSize(std::string_view line, std::uint32_t& height, std::uint32_t& width)
{
    const auto number = [&](std::string_view prefix, std::uint32_t& value) {
        if (!line.starts_with(prefix))
            return false;
        line.remove_prefix(prefix.size());
        const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
        line.remove_prefix(end - line.data());
        return error == std::errc{};
    };
    return number("-Y ", height) && number(" +X ", width);
}

// A row in the run-length encoding of 1991: the four components one after the other. False:
// damaged.
bool readRuns(Reader& reader, std::span<Rgbe> row)
{
    for (const auto component : {&Rgbe::r, &Rgbe::g, &Rgbe::b, &Rgbe::e}) {
        for (std::size_t x = 0; x < row.size();) {
            const std::uint8_t code = reader.byte();
            const bool run = code > 128;
            const std::size_t count = run ? code - 128 : code;
            if (count == 0 || count > row.size() - x || reader.failed)
                return false;
            const std::uint8_t value = run ? reader.byte() : std::uint8_t{0};
            for (const std::size_t end = x + count; x < end; ++x)
                row[x].*component = run ? value : reader.byte();
        }
    }
    return !reader.failed;
}

} // namespace

Result<EnvironmentSource> decodeRadianceHdr(std::span<const std::byte> bytes, PictureLimit limit)
{
    Reader reader(bytes);
    if (!reader.line().starts_with("#?"))
        return Error{"not a Radiance picture; save it as .hdr or .exr"};
    bool rgbe = false;
    double exposure = 1; // what the pixels were multiplied by, in all
    for (std::string_view line = reader.line(); !line.empty(); line = reader.line()) {
        rgbe |= line == "FORMAT=32-bit_rle_rgbe";
        if (!takeExposure(line, exposure))
            return Error{
                fmt::format("\"{}\" is no factor from 1e-6 to 1e6; mend or delete the line",
                            line.substr(0, 40))};
    }
    EnvironmentSource source;
    if (!parseSize(reader.line(), source.height, source.width) || reader.failed)
        return Error{"no size line of the form \"-Y height +X width\"; save it upright, or again "
                     "if it is cut"};
    if (!rgbe)
        return Error{"FORMAT is not 32-bit_rle_rgbe; convert the picture to RGBE"};
    if (source.width < 1 || source.width > limit.width || source.height < 1 ||
        source.height > limit.height)
        return Error{fmt::format("{} x {} pixels, the limit is {} x {}; scale it down",
                                 source.width, source.height, limit.width, limit.height)};
    // A run code and its value make at most 127 pixels of one component: a cheap bound before
    // memory is taken.
    const std::size_t pixels = std::size_t{source.width} * source.height;
    if (reader.left() < pixels / 127 * 8)
        return Error{fmt::format(
            "{} bytes of pixels, too few for {} x {}: the file is cut; copy or save it again",
            reader.left(), source.width, source.height)};
    source.pixels.reserve(pixels);
    const auto brighter = static_cast<float>(1 / exposure);
    std::vector<Rgbe> row(source.width);
    for (std::uint32_t y = 0; y < source.height; ++y) {
        const Rgbe first = reader.pixel();
        const bool runs = source.width >= 8 && source.width < 32768 && first.r == 2 &&
                          first.g == 2 && first.b < 128;
        bool good = true;
        if (runs) {
            good = first.b * 256u + first.e == source.width && readRuns(reader, row);
        } else {
            row[0] = first;
            for (std::uint32_t x = 1; x < source.width; ++x)
                row[x] = reader.pixel();
        }
        if (!good || reader.failed)
            return Error{fmt::format("row {} of {} is damaged or cut; copy or save it again", y,
                                     source.height)};
        for (const Rgbe& pixel : row)
            source.pixels.push_back(radiance(pixel) * brighter);
    }
    return source;
}

} // namespace penumbra
