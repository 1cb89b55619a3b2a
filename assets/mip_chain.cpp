#include "assets/image_decoder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace penumbra {

namespace {

// Linear light of all 8-bit sRGB values (IEC 61966-2-1), and back to the nearest of them.
class Srgb8 {
public:
    Srgb8()
    {
        for (std::size_t i = 0; i < m_linear.size(); ++i)
            m_linear[i] = linearOf(static_cast<double>(i));
        for (std::size_t i = 0; i < m_above.size(); ++i)
            m_above[i] = linearOf(static_cast<double>(i) + 0.5);
    }
    [[nodiscard]] float linear(std::uint8_t value) const { return m_linear[value]; }
    [[nodiscard]] std::uint8_t nearest(float linear) const
    {
        return static_cast<std::uint8_t>(std::upper_bound(m_above.begin(), m_above.end(), linear) -
                                         m_above.begin());
    }

private:
    static float linearOf(double value)
    {
        const double s = value / 255;
        return static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
    }
    std::array<float, 256> m_linear;
    std::array<float, 255> m_above; // between value i and the next
};

// The pixels of a row of `from` that pixel i of a row of `to` covers, and their weights.
struct Cover {
    std::uint32_t first = 0, count = 0;
    std::array<float, 4> weight{}; // at most 3 and two halves: 2 <= from / to <= 3
};

std::vector<Cover> covers(std::uint32_t from, std::uint32_t to)
{
    std::vector<Cover> result;
    const double size = static_cast<double>(from) / to;
    for (std::uint32_t i = 0; i < to; ++i) {
        const double begin = i * size, end = std::min((i + 1) * size, static_cast<double>(from));
        Cover cover{static_cast<std::uint32_t>(begin)};
        for (std::uint32_t k = cover.first; k < end && cover.count < cover.weight.size(); ++k)
            cover.weight[cover.count++] =
                static_cast<float>((std::min(end, k + 1.0) - std::max<double>(begin, k)) / size);
        result.push_back(cover);
    }
    return result;
}

} // namespace

MipChain makeMipChain(DecodedImage image)
{
    static const Srgb8 kSrgb;
    MipChain chain{static_cast<std::uint32_t>(std::bit_width(std::max(image.width, image.height))),
                   std::move(image.rgba)};
    std::size_t above = 0; // where the level before begins
    for (std::uint32_t level = 1; level < chain.levels; ++level) {
        const std::uint32_t width = std::max(image.width / 2, 1u);
        const std::uint32_t height = std::max(image.height / 2, 1u);
        const std::vector<Cover> columns = covers(image.width, width);
        const std::size_t begin = chain.rgba.size();
        chain.rgba.resize(begin + std::size_t{4} * width * height);
        std::uint8_t* out = chain.rgba.data() + begin;
        for (const Cover& rows : covers(image.height, height)) {
            for (const Cover& cover : columns) {
                vec3 color(0), plain(0); // with and without the weight of alpha
                float alpha = 0;
                for (std::uint32_t r = 0; r < rows.count; ++r)
                    for (std::uint32_t c = 0; c < cover.count; ++c) {
                        const std::uint8_t* p =
                            &chain.rgba[above + 4 * (std::size_t{rows.first + r} * image.width +
                                                     cover.first + c)];
                        const float weight = rows.weight[r] * cover.weight[c];
                        const vec3 linear(kSrgb.linear(p[0]), kSrgb.linear(p[1]),
                                          kSrgb.linear(p[2]));
                        alpha += weight * p[3];
                        color += weight * p[3] * linear;
                        plain += weight * linear;
                    }
                color = alpha > 0 ? color / alpha : plain;
                for (int k = 0; k < 3; ++k)
                    *out++ = kSrgb.nearest(color[k]);
                *out++ = static_cast<std::uint8_t>(alpha + 0.5f);
            }
        }
        above = begin;
        image.width = width;
        image.height = height;
    }
    return chain;
}

} // namespace penumbra
