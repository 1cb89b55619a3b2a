// Part of the editor panel: the scene into a file, and what came of it.
#pragma once

#include "demo/scene.h"

namespace penumbra {

class SavePanel {
public:
    // Inside an ImGui frame, between two runs of the schedule. `assets`: folder of compiled assets.
    void draw(DemoScene& scene, const Camera& camera, const std::filesystem::path& assets);

private:
    char m_file[256] = {}; // empty: the scene's own, or its name
    std::string m_outcome;
};

} // namespace penumbra
