#include "demo/sky_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace penumbra {

EnvironmentLight skyAt(const SkyMotion& motion, const EnvironmentLight& now, double time)
{
    constexpr double kPi = std::numbers::pi;
    const double half = std::fmod(motion.turn * time, 2 * kPi) / 2;
    const double fade =
        motion.period > 0 ? std::cos(2 * kPi * (time / motion.period + motion.phase)) : 1;
    EnvironmentLight sky = now;
    sky.rotation = vec4(0, std::sin(half), 0, std::cos(half));
    sky.intensity = motion.intensity * static_cast<float>(0.5 + 0.5 * fade);
    return sky;
}

void moveSkies(const ecs::SystemContext& context, double time)
{
    context.query<const SkyMotion, EnvironmentLight>().each(
        [&](const SkyMotion& motion, EnvironmentLight& sky) { sky = skyAt(motion, sky, time); });
}

void fadeSkies(const ecs::SystemContext& context, float seconds)
{
    context.query<const SkyFade, EnvironmentLight>().each(
        [&](ecs::Entity entity, const SkyFade& fade, EnvironmentLight& sky) {
            const float step = fade.perSecond * seconds;
            sky.intensity += std::clamp(fade.to - sky.intensity, -step, step);
            if (sky.intensity != fade.to)
                return;
            if (fade.to == 0)
                context.commands().destroy(entity);
            else
                context.commands().remove<SkyFade>(entity);
        });
}

} // namespace penumbra
