// Small OpenEXR pictures of known content.
#pragma once

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <cstddef>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

namespace penumbra {

inline std::vector<std::byte> toBytes(const std::string& text)
{
    std::vector<std::byte> bytes(text.size());
    std::memcpy(bytes.data(), text.data(), text.size());
    return bytes;
}

class StringStream final : public Imf::OStream {
public:
    StringStream() : OStream("memory") {}
    void write(const char data[], int count) override { m_out.write(data, count); }
    std::uint64_t tellp() override { return m_out.tellp(); }
    void seekp(std::uint64_t position) override
    {
        m_out.seekp(static_cast<std::streamoff>(position));
    }
    [[nodiscard]] std::string str() const { return m_out.str(); }

private:
    std::ostringstream m_out;
};

// Channels one letter each; channel c of pixel (x, y) is 100 c + 10 y + x, in a data window that
// starts at (3, -2).
inline std::vector<std::byte> makeExr(const std::string& channels, Imf::Compression compression,
                                      bool tiled)
{
    constexpr int kWidth = 8, kHeight = 4;
    const Imath::Box2i window({3, -2}, {3 + kWidth - 1, -2 + kHeight - 1});
    Imf::Header header(window, window);
    header.compression() = compression;
    if (tiled)
        header.setTileDescription(Imf::TileDescription(4, 4));
    std::vector<float> values(channels.size() * kWidth * kHeight);
    Imf::FrameBuffer frame;
    for (std::size_t c = 0; c < channels.size(); ++c) {
        float* plane = values.data() + c * kWidth * kHeight;
        for (int i = 0; i < kWidth * kHeight; ++i)
            plane[i] = 100.0f * c + 10.0f * (i / kWidth) + i % kWidth;
        const std::string name(1, channels[c]);
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        frame.insert(name, Imf::Slice::Make(Imf::FLOAT, plane, window, sizeof(float),
                                            kWidth * sizeof(float)));
    }
    StringStream stream;
    if (tiled) {
        Imf::TiledOutputFile file(stream, header);
        file.setFrameBuffer(frame);
        file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    } else {
        Imf::OutputFile file(stream, header);
        file.setFrameBuffer(frame);
        file.writePixels(kHeight);
    }
    return toBytes(stream.str());
}

} // namespace penumbra
