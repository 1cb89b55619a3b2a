#include "demo/save_panel.h"

#include "demo/scene_file.h"

#include <fmt/ranges.h>
#include <imgui.h>

namespace penumbra {

void SavePanel::draw(DemoScene& scene, const Camera& camera, const std::filesystem::path& assets)
{
    const std::string own = scene.path.empty() ? scene.name + ".json" : scene.path.string();
    ImGui::SetNextItemWidth(-60);
    ImGui::InputTextWithHint("##file", own.c_str(), m_file, sizeof(m_file));
    ImGui::SameLine();
    if (ImGui::Button("save")) {
        std::string file = m_file[0] ? m_file : own;
        if (!file.ends_with(".json"))
            file += ".json";
        const Result<std::vector<std::string>> saved = saveSceneFile(scene, camera, file, assets);
        m_outcome = saved ? fmt::format("saved to {}; show it with --scene {}\n{}", file, file,
                                        fmt::join(*saved, "\n"))
                          : saved.error().message;
    }
    if (!m_outcome.empty())
        ImGui::TextWrapped("%s", m_outcome.c_str());
}

} // namespace penumbra
