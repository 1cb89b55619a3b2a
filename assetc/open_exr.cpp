// OpenEXR pictures through the library, which throws: nothing leaves this file but a Result.
#include "assetc/environment.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <cstring>
#include <stdexcept>

namespace penumbra {

namespace {

class MemoryStream final : public Imf::IStream {
public:
    explicit MemoryStream(std::span<const std::byte> bytes) : IStream("memory"), m_bytes(bytes) {}

    bool isMemoryMapped() const override { return false; }

    bool read(char out[], int count) override
    {
        if (count < 0 || m_at > m_bytes.size() ||
            static_cast<std::size_t>(count) > m_bytes.size() - m_at)
            throw std::runtime_error("the file is cut");
        std::memcpy(out, m_bytes.data() + m_at, count);
        m_at += count;
        return m_at < m_bytes.size();
    }

    std::uint64_t tellg() override { return m_at; }
    void seekg(std::uint64_t position) override { m_at = position; }

private:
    std::span<const std::byte> m_bytes;
    std::uint64_t m_at = 0;
};

// Linear Rec. 709 from the file's primaries; the identity when the file names none.
glm::dmat3 rec709FromFile(const Imf::Header& header)
{
    if (!Imf::hasChromaticities(header))
        return glm::dmat3(1.0);
    // OpenEXR multiplies row vectors, so its matrices are in memory what GLM's column-vector ones
    // are.
    const Imath::M44f m = Imf::RGBtoXYZ(Imf::chromaticities(header), 1.0f) *
                          Imf::XYZtoRGB(Imf::Chromaticities(), 1.0f);
    glm::dmat3 result;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            result[i][j] = m[i][j];
    return result;
}

Result<EnvironmentSource> read(std::span<const std::byte> bytes, PictureLimit limit)
{
    MemoryStream stream(bytes);
    Imf::InputFile file(stream, 1);
    const Imf::Header& header = file.header();
    if (Imf::hasEnvmap(header) && Imf::envmap(header) != Imf::ENVMAP_LATLONG)
        return Error{"a cube map; convert it to an equirectangular (latlong) map"};
    const Imath::Box2i window = header.dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    if (width < 1 || width > limit.width || height < 1 || height > limit.height)
        return Error{fmt::format("{} x {} pixels, the limit is {} x {}", width, height, limit.width,
                                 limit.height)};
    const Imf::ChannelList& channels = header.channels();
    const bool rgb =
        channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B");
    const bool chroma = channels.findChannel("RY") || channels.findChannel("BY");
    if (!rgb && (chroma || !channels.findChannel("Y")))
        return Error{"needs the channels R, G, B, or Y alone; save it as plain RGB"};

    EnvironmentSource source;
    source.width = static_cast<std::uint32_t>(width);
    source.height = static_cast<std::uint32_t>(height);
    source.pixels.resize(std::size_t{source.width} * source.height);
    Imf::FrameBuffer frame;
    const char* names[] = {rgb ? "R" : "Y", "G", "B"};
    for (int c = 0; c < (rgb ? 3 : 1); ++c) {
        const Imf::Channel& channel = *channels.findChannel(names[c]);
        if (channel.xSampling != 1 || channel.ySampling != 1)
            return Error{
                fmt::format("channel {} is subsampled; save it at full resolution", names[c])};
        char* first = reinterpret_cast<char*>(&source.pixels[0][c]);
        frame.insert(names[c], Imf::Slice::Make(Imf::FLOAT, first, window, sizeof(vec3),
                                                sizeof(vec3) * static_cast<std::size_t>(width)));
    }
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);

    const glm::dmat3 rec709 = rec709FromFile(header);
    for (vec3& pixel : source.pixels) {
        if (!rgb)
            pixel = vec3(pixel.r);
        else if (rec709 != glm::dmat3(1.0))
            pixel = vec3(rec709 * glm::dvec3(pixel));
    }
    return source;
}

} // namespace

Result<EnvironmentSource> decodeOpenExr(std::span<const std::byte> bytes, PictureLimit limit)
{
    try {
        Imf::Header::setMaxImageSize(kMaxSourceWidth,
                                     kMaxSourceHeight); // refuses before it takes memory
        Imf::Header::setMaxTileSize(kMaxSourceWidth, kMaxSourceHeight);
        return read(bytes, limit);
    } catch (const std::exception& error) {
        return Error{fmt::format("OpenEXR: {}", error.what())};
    }
}

} // namespace penumbra
