// Scene files of the components of tests/runtime/ecs/described.h.
#include "tests/fuzz/seeds.h"
#include "tests/runtime/ecs/street_scene.h"

#include <span>

namespace penumbra {

namespace {

// Every type of member, a parent, a singleton; parts that the program does not know.
constexpr std::string_view kEntities = R"({
 "version": 1,
 "entities": [
  {"Name": {"value": "base"}, "Place": {"x": -0.0, "y": 0.1, "z": 3}},
  {"Parent": {"entity": 0}, "Everything": {"power": 0.1, "exact": 1e-300, "offset": -32768,
   "count": 18446744073709551615, "on": false, "shape": "sphere", "colour": [1e-7, 0, 16777217],
   "rotation": [0.6, 0, 0, -0.8], "target": 0, "label": "\"\u00e9\n", "mesh": "arm.glb"}},
  {"Upgraded": {"version": 3, "level": "high"}, "Place": {"x": 1, "w": "later"}, "Unknown": [{}]},
  {"Clock": {"frame": 9}, "Asleep": {}}
 ],
 "singletons": {"Clock": 3},
 "lights": [{"entity": 1, "type": "point"}],
 "future": [1]
})";

FuzzSeed seed(const char* name, std::string_view text)
{
    const auto bytes = std::as_bytes(std::span(text));
    return {name, {bytes.begin(), bytes.end()}};
}

} // namespace

std::vector<FuzzSeed> sceneSeeds()
{
    return {seed("empty.json", R"({"version": 1, "entities": []})"),
            seed("entities.json", kEntities), seed("prefabs.json", ecs::kStreetScene)};
}

} // namespace penumbra
