// A scene file that uses all of prefabs: nested ones, instances with overrides, links into
// instances, parts that nobody knows. Its components are those of described.h.
#pragma once

#include <string_view>

namespace penumbra::ecs {

inline constexpr std::string_view kStreetScene = R"({
 "version": 1,
 "prefabs": {
  "bulb": {"entities": [{"Name": {"value": "bulb"}, "Everything": {"power": 60}}]},
  "lamp": {"entities": [
   {"Name": {"value": "post"}, "Place": {"x": 1}},
   {"Name": {"value": "arm"}, "Parent": {"entity": 0}, "Asleep": {}},
   {"prefab": "bulb", "Parent": {"entity": 1}, "Everything": {"target": 0}},
   {"Parent": {"entity": 0}, "Future": {"a": 1}}
  ]}
 },
 "entities": [
  {"Name": {"value": "street"}},
  {"prefab": "lamp", "Parent": {"entity": 0}, "Place": {"y": 2}},
  {"prefab": "lamp", "Name": {"value": "broken"}, "Place": null,
   "overrides": {"bulb": {"Everything": {"power": 5}, "Clock": {}}, "arm": {"Asleep": null}, "3": null}},
  {"Parent": {"entity": [2, "arm"]}, "Everything": {"target": [1, "bulb"]}},
  {"prefab": "bulb"}
 ]
})";

} // namespace penumbra::ecs
