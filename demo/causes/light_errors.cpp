#include "demo/causes/light_errors.h"

#include "demo/reference/sh4_light.h"
#include "demo/spread_receivers.h"

#include <map>
#include <nlohmann/json.hpp>

namespace penumbra {

namespace {

constexpr std::uint32_t kCauseReceivers = 4096; // order 4 is dearer to trace than the light itself

double ratio(double value, double mean)
{
    return mean > 0 ? value / mean : 0;
}

// Lights add up, and so do the radiances of those of one kind.
RadianceErrors errorsOfKind(std::span<const LightErrors> lights, const std::string& asset)
{
    std::vector<vec3> test, truth, unshadowed;
    for (const LightErrors& light : lights) {
        if (light.asset != asset)
            continue;
        test.resize(light.test.size());
        truth.resize(light.test.size());
        unshadowed.resize(light.test.size());
        for (std::size_t i = 0; i < test.size(); ++i) {
            test[i] += light.test[i];
            truth[i] += light.truth.shadowed[i];
            unshadowed[i] += light.truth.unshadowed[i];
        }
    }
    return compareRadiance(test, truth, unshadowed);
}

} // namespace

LightErrors measureLight(const TracedScene& traced, const Receivers& receivers, std::size_t index,
                         std::string asset, std::vector<vec3> test, std::uint32_t samples)
{
    const AreaLight& light = traced.lights[index];
    const Environment night = makeEnvironment(2, 1, std::vector<vec3>(2));
    const ReferenceLight dark = ReferenceLight::fromMap(night);
    LightErrors out;
    out.asset = std::move(asset);
    out.truth = shadeReference(traced.scene, {dark, std::span(&light, 1)}, receivers.receivers,
                               {.samples = samples});
    out.errors = compareRadiance(test, out.truth.shadowed, out.truth.unshadowed);

    const std::vector<std::uint32_t> chosen = spreadReceivers(receivers, kCauseReceivers);
    const std::vector<vec3> order4 =
        shadeSh4(
            traced.scene, [&](const ReferenceReceiver& r) { return sh4Of(light, r.position); },
            pick<ReferenceReceiver>(receivers.receivers, chosen), {.samples = samples},
            light.instance())
            .shadowed;
    const std::vector<vec3> truth = pick<vec3>(out.truth.shadowed, chosen);
    const std::vector<vec3> unshadowed = pick<vec3>(out.truth.unshadowed, chosen);
    out.lightBandLimit = compareRadiance(order4, truth, unshadowed).rmseRelative;
    out.fieldsAndProducts =
        compareRadiance(pick<vec3>(test, chosen), order4, unshadowed).rmseRelative;
    out.test = std::move(test);
    return out;
}

nlohmann::ordered_json errorsJson(const RadianceErrors& errors)
{
    return {{"meanUnshadowed", errors.meanUnshadowed},
            {"rmse", errors.rmse},
            {"rmseRelative", errors.rmseRelative},
            {"bias", errors.bias},
            {"biasRelative", ratio(errors.bias, errors.meanUnshadowed)},
            {"maxAbs", errors.maxAbs}};
}

nlohmann::ordered_json byLightJson(const RadianceErrors& environment, const RadianceErrors& local,
                                   std::span<const LightErrors> lights)
{
    nlohmann::ordered_json kinds, each = nlohmann::ordered_json::array();
    for (const LightErrors& light : lights) {
        if (!kinds.contains(light.asset))
            kinds[light.asset] = errorsJson(errorsOfKind(lights, light.asset));
        nlohmann::ordered_json entry{{"asset", light.asset}};
        entry.update(errorsJson(light.errors));
        entry["byCause"] = {{"lightBandLimit", light.lightBandLimit},
                            {"fieldsAndProducts", light.fieldsAndProducts}};
        each.push_back(std::move(entry));
    }
    return {{"environment", errorsJson(environment)},
            {"local", errorsJson(local)},
            {"byAsset", kinds},
            {"lights", each}};
}

} // namespace penumbra
