#include "assetc/sheet/contact_sheet.h"
#include "assetc/sheet/theme.h"
#include "assets/sh_basis.h"
#include "shaders/shared/environment.h"

#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <tbb/parallel_for.h>

namespace penumbra {

namespace {

constexpr int kMapWidth = kSheetWidth - 2 * kMargin;
constexpr int kShWidth = (kMapWidth - kGap) / 2;

// Half the display's range at the mean, all the rest rolls off.
Color toneMap(vec3 radiance, float exposure)
{
    const auto curve = [&](float x) { return 1 - std::exp(-exposure * std::max(x, 0.0f)); };
    return displayColor(vec3(curve(radiance.x), curve(radiance.y), curve(radiance.z)));
}

Canvas drawEquirect(int width, float exposure, const std::function<vec3(vec2)>& radiance)
{
    Canvas canvas(width, width / 2);
    tbb::parallel_for(0, canvas.height(), [&](int y) {
        for (int x = 0; x < width; ++x)
            canvas.at(x, y) =
                toneMap(radiance(vec2((static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                                      (static_cast<float>(y) + 0.5f) /
                                          static_cast<float>(canvas.height()))),
                        exposure);
    });
    return canvas;
}

} // namespace

Canvas drawEnvironmentSheet(const Environment& environment, std::size_t bytes)
{
    const float exposure =
        std::numbers::ln2_v<float> / std::max(environment.statistics.meanLuminance, 1e-20f);
    const int mapTop = kMargin + 2 * kLineHeight;
    const int shTop = mapTop + kMapWidth / 2 + kGap + kLineHeight;
    Canvas sheet(kSheetWidth, shTop + kShWidth / 2 + kMargin, kBackground);
    sheet.text(kMargin, kMargin,
               fmt::format("environment {} x {}  {} bytes", environment.mapWidth,
                           environment.mapHeight, bytes),
               kText);
    sheet.text(kMargin, kMargin + kLineHeight,
               fmt::format("mean {:.3g}  brightest {:.3g} W/(m2 sr)",
                           environment.statistics.meanLuminance,
                           environment.statistics.maxLuminance),
               kFaintText);
    sheet.draw(kMargin, mapTop, drawEquirect(kMapWidth, exposure, [&](vec2 uv) {
                   const auto pixel = [](float at, std::uint32_t size) {
                       return std::min(static_cast<std::uint32_t>(at * static_cast<float>(size)),
                                       size - 1);
                   };
                   return environment
                       .map[std::size_t{pixel(uv.y, environment.mapHeight)} * environment.mapWidth +
                            pixel(uv.x, environment.mapWidth)];
               }));
    for (const int order : {4, 6}) {
        const int left = order == 4 ? kMargin : kMargin + kShWidth + kGap;
        sheet.text(left, shTop - kLineHeight,
                   fmt::format("order {}: {:.1f} % of the energy", order,
                               100 * environmentEnergyShare(environment, order)),
                   kFaintText);
        sheet.draw(left, shTop, drawEquirect(kShWidth, exposure, [&](vec2 uv) {
                       std::array<double, 36> basis{};
                       const auto used =
                           std::span(basis).first(static_cast<std::size_t>(order) * order);
                       shBasisAnyOrder(order, glm::dvec3(equirectDirection(uv)), used);
                       vec3 sum(0);
                       for (std::size_t i = 0; i < used.size(); ++i)
                           sum += static_cast<float>(basis[i]) * environment.sh6[i];
                       return sum;
                   }));
    }
    return sheet;
}

} // namespace penumbra
