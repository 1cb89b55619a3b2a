#include "assetc/sheet/contact_sheet.h"

#include "assetc/sheet/mesh_picture.h"
#include "assetc/sheet/shells.h"
#include "assetc/sheet/theme.h"

#include <algorithm>
#include <bit>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

namespace penumbra {

namespace {

constexpr int kInner = kSheetWidth - 2 * kMargin;
constexpr int kMeshWidth = 656, kMeshHeight = 440;
constexpr std::size_t kMapsShown = 6;
constexpr int kMapSize = (kInner - static_cast<int>(kMapsShown - 1) * kGap) / kMapsShown;
constexpr int kBarHeight = 88;
constexpr int kTop = kMargin + 40;                   // below the name
constexpr int kMapsTop = kTop + kMeshHeight + 48;    // below their heading
constexpr int kSidesTop = kMapsTop + kMapSize + 120; // below captions and heading
constexpr int kErrorsTop = kSidesTop + kBarHeight + 64;

std::vector<std::string> factsOf(const MeshAsset& mesh, std::size_t bytes)
{
    const vec3 size = mesh.boundsMax - mesh.boundsMin;
    std::vector<std::string> facts = {
        fmt::format("{} vertices", mesh.positions.size()),
        fmt::format("{} triangles", mesh.indices.size() / 3),
        fmt::format("materials {}  lods {}", std::max<std::size_t>(mesh.materials.size(), 1),
                    mesh.lods.size()),
        fmt::format("{:.3g} x {:.3g} x {:.3g} m", size.x, size.y, size.z),
        fmt::format("{:.1f} kB in all", static_cast<double>(bytes) / 1000),
        ""};
    if (!mesh.field) {
        facts.emplace_back("no field");
        return facts;
    }
    const ShadowField& field = *mesh.field;
    const auto leftOut = std::count(field.shellSides.begin(), field.shellSides.end(), 0);
    facts.push_back(
        fmt::format("{} field", field.kind == FieldKind::Occlusion ? "occlusion" : "radiance"));
    facts.push_back(
        fmt::format("{:.1f} kB unpacked", static_cast<double>(field.texels.size()) / 1000));
    facts.push_back(fmt::format("{} shells, {} left out", field.shellSides.size(), leftOut));
    facts.push_back(
        fmt::format("from {:.3g} to {:.3g} radii", field.innerRadius, field.outerRadius));
    facts.push_back(fmt::format("bounding radius {:.3g} m", field.radius));
    if (field.directions > 0)
        facts.push_back(fmt::format("{} directions", field.directions));
    if (field.frames > 1)
        facts.push_back(fmt::format("{} frames, the first here", field.frames));
    if (field.errors)
        facts.push_back(fmt::format("error {:.4f} rms  {:.3f} max", field.errors->total.rms,
                                    field.errors->total.max));
    return facts;
}

void drawMaps(Canvas& sheet, const ShadowField& field, const Shells& shells,
              const std::vector<std::size_t>& shown)
{
    const bool occlusion = field.kind == FieldKind::Occlusion;
    sheet.text(kMargin, kMapsTop - kLineHeight,
               occlusion ? "mean visibility on shells, octahedral maps, centre +z"
                         : "mean radiance on shells, each over its brightest, centre +z",
               kFaintText);
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const std::size_t shell = shown[i];
        const int x = kMargin + static_cast<int>(i) * (kMapSize + kGap);
        sheet.draw(x, kMapsTop, shells.draw(shell, kMapSize));
        const int below = kMapsTop + kMapSize + 10;
        sheet.text(x, below, fmt::format("{}: {:.3g} radii", shell, shellRadius(field, shell)),
                   kAccent);
        const Shells::Range range = shells.range(shell);
        const std::string side = field.shellSides[shell] == 0
                                     ? "left out"
                                     : fmt::format("side {}", field.shellSides[shell]);
        sheet.text(x, below + 20, side, kText);
        const std::string values = occlusion
                                       ? fmt::format("{:.3f} - {:.3f}", range.low, range.high)
                                       : fmt::format("{:.2g} - {:.2g}", range.low, range.high);
        sheet.text(x, below + 40, values, kFaintText);
    }
}

// A bar per shell; `heights` from 0 to 1, below 0: nothing to show.
void drawBars(Canvas& sheet, int top, const std::string& heading, const std::vector<float>& heights,
              const std::vector<std::size_t>& shown)
{
    const int count = static_cast<int>(heights.size());
    sheet.text(kMargin, top - kLineHeight, heading, kFaintText);
    sheet.fill(kMargin, top, kInner, kBarHeight, kPanel);
    for (int i = 0; i < count; ++i) {
        const auto shell = static_cast<std::size_t>(i);
        const int left = kMargin + i * kInner / count, right = kMargin + (i + 1) * kInner / count;
        const int height = static_cast<int>(
            std::lround(std::clamp(heights[shell], 0.0f, 1.0f) * (kBarHeight - 8)));
        const bool marked = std::find(shown.begin(), shown.end(), shell) != shown.end();
        const int inset = right - left > 12 ? 3 : 1;
        sheet.fill(left + inset, top + kBarHeight - height, right - left - 2 * inset, height,
                   marked ? kAccent : kBar);
        if (marked) {
            const std::string label = fmt::format("{}", i);
            const int middle = (left + right - textWidth(label)) / 2 + 1;
            sheet.text(middle, top + kBarHeight + 8, label, kAccent);
        }
    }
    sheet.fill(kMargin, top + kBarHeight, kInner, 2, kLine);
}

void drawSides(Canvas& sheet, const ShadowField& field, const std::vector<std::size_t>& shown)
{
    // By powers of two: 2^k + 1 is k high.
    const auto exponent = [](std::uint32_t side) { return std::bit_width(side - 1) - 1; };
    const auto highest = static_cast<float>(exponent(largestSide(field)));
    std::vector<float> heights;
    for (const std::uint32_t side : field.shellSides)
        heights.push_back(side == 0 ? -1.0f : static_cast<float>(exponent(side)) / highest);
    drawBars(sheet, kSidesTop,
             fmt::format("side of each shell, by powers of two; highest {}; none: left out",
                         largestSide(field)),
             heights, shown);
}

void drawErrors(Canvas& sheet, const Shells& shells, std::size_t count, const EmbreeScene& scene,
                const std::vector<std::size_t>& shown)
{
    std::vector<float> errors(count);
    tbb::parallel_for(std::size_t{0}, count,
                      [&](std::size_t shell) { errors[shell] = shells.tracedError(shell, scene); });
    const float highest = std::max(*std::max_element(errors.begin(), errors.end()), 1e-6f);
    for (float& error : errors)
        error /= highest;
    drawBars(
        sheet, kErrorsTop,
        fmt::format("rms error of each shell at its radius, against traced rays; highest {:.4f}",
                    highest),
        errors, shown);
}

} // namespace

Canvas drawMeshSheet(const MeshAsset& mesh, std::size_t bytes)
{
    const bool occlusion = mesh.field && mesh.field->kind == FieldKind::Occlusion;
    const int bottom = !mesh.field ? kTop + kMeshHeight
                       : occlusion ? kErrorsTop + kBarHeight + kLineHeight
                                   : kSidesTop + kBarHeight + kLineHeight;
    Canvas sheet(kSheetWidth, bottom + kMargin, kBackground);
    const std::size_t fits = kInner / static_cast<std::size_t>(textWidth("x", 3));
    sheet.text(kMargin, kMargin, mesh.name.substr(0, fits), kText, 3);
    const EmbreeScene scene(mesh.positions, mesh.indices);
    sheet.draw(kMargin, kTop, drawMesh(mesh, scene, kMeshWidth, kMeshHeight, kPanel));
    int y = kTop + 4;
    for (const std::string& fact : factsOf(mesh, bytes)) {
        sheet.text(kMargin + kMeshWidth + kMargin, y, fact, kText);
        y += kLineHeight + 4;
    }
    if (!mesh.field)
        return sheet;
    const Shells shells(*mesh.field);
    const std::vector<std::size_t> shown = shellsToShow(*mesh.field, kMapsShown);
    drawMaps(sheet, *mesh.field, shells, shown);
    drawSides(sheet, *mesh.field, shown);
    if (occlusion)
        drawErrors(sheet, shells, mesh.field->shellSides.size(), scene, shown);
    return sheet;
}

std::string meshSheetText(const MeshAsset& mesh)
{
    std::string text = "the mesh with its self-visibility";
    if (!mesh.field)
        return text;
    const bool occlusion = mesh.field->kind == FieldKind::Occlusion;
    text += "; some shells of the field as octahedral maps, a square per node (";
    text += occlusion ? "grey: mean visibility v as 1 - sqrt(1 - v)"
                      : "colour: radiance over the shell's brightest";
    text += "); the side of every shell, inner one left, no bar where left out";
    return occlusion ? text + "; rms error of every shell against traced rays" : text;
}

} // namespace penumbra
