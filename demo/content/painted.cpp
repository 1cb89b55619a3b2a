#include "demo/content/painted.h"

#include "demo/content/shapes.h"

#include <glm/gtc/constants.hpp>

namespace penumbra {

namespace {

constexpr std::array<std::uint8_t, 4> kCloth = {238, 232, 218, 255};
constexpr std::array<std::array<std::uint8_t, 4>, 3> kGores = {
    {{190, 44, 38, 255}, {28, 88, 158, 255}, {232, 168, 34, 255}}};

// Six gores, coloured and of cloth in turn, between two caps; longitude runs right, the north pole
// is the upper side.
Image8 makeBeachBallPicture()
{
    constexpr std::uint32_t kWidth = 768, kHeight = 384, kCap = 34;
    Image8 image = makeImage(kWidth, kHeight);
    for (std::uint32_t y = 0; y < kHeight; ++y)
        for (std::uint32_t x = 0; x < kWidth; ++x) {
            const std::uint32_t gore = 6 * x / kWidth;
            const std::uint32_t toPole = std::min(y, kHeight - 1 - y);
            std::array<std::uint8_t, 4> color = gore % 2 == 0 ? kGores[gore / 2] : kCloth;
            if (toPole < kCap)
                color = kCloth;
            else if (toPole < kCap + 5)
                color = {60, 56, 52, 255}; // the seam of the cap
            for (std::size_t c = 0; c < 4; ++c)
                image.rgba[4 * (std::size_t{y} * kWidth + x) + c] = color[c];
        }
    return image;
}

} // namespace

PaintedMesh makeBeachBall()
{
    constexpr int kRows = 40, kTurns = 64;
    constexpr float kRadius = 0.18f;
    PaintedMesh painted{{.name = "beach_ball"}, {}, {}, makeBeachBallPicture()};
    ContentMesh& mesh = painted.mesh;
    for (int row = 0; row <= kRows; ++row)
        for (int turn = 0; turn <= kTurns; ++turn) { // the last column closes the picture
            const vec2 uv(static_cast<float>(turn) / kTurns, static_cast<float>(row) / kRows);
            const float a = glm::pi<float>() * uv.y, b = glm::two_pi<float>() * uv.x;
            // Equal places to the bit: at the poles, and where the last column meets the first.
            const bool pole = row == 0 || row == kRows;
            const float sine = pole ? 0 : std::sin(a);
            const float around = turn == kTurns ? 0 : b;
            mesh.normals.push_back(
                pole ? vec3(0, row == 0 ? 1 : -1, 0)
                     : vec3(sine * std::cos(around), std::cos(a), -sine * std::sin(around)));
            mesh.positions.push_back(kRadius * mesh.normals.back());
            painted.texcoords.push_back(uv);
        }
    for (std::uint32_t row = 0; row < kRows; ++row)
        for (std::uint32_t turn = 0; turn < kTurns; ++turn) {
            const std::uint32_t a = row * (kTurns + 1) + turn, b = a + kTurns + 1;
            if (row > 0)
                mesh.indices.insert(mesh.indices.end(), {a, b + 1, a + 1});
            if (row + 1 < kRows)
                mesh.indices.insert(mesh.indices.end(), {a, b, b + 1});
        }
    return painted;
}

PaintedMesh makePaintedKnot()
{
    PaintedMesh painted{makeTorusKnot(), {}, {}, {}};
    painted.mesh.name = "painted_knot";
    for (const vec3& p : painted.mesh.positions) {
        const float phase = std::atan2(p.z, p.x) + 22 * p.y;
        std::array<std::uint8_t, 4> color{0, 0, 0, 255};
        for (std::size_t c = 0; c < 3; ++c) {
            const float wave = std::cos(phase - glm::two_pi<float>() / 3 * static_cast<float>(c));
            color[c] = static_cast<std::uint8_t>(255 * (0.34f + 0.28f * wave) + 0.5f);
        }
        painted.colors.push_back(color);
    }
    return painted;
}

std::span<const PaintedShape> paintedShapes()
{
    static constexpr PaintedShape kShapes[] = {
        {"beach_ball", "a ball with a texture, as glTF", makeBeachBall},
        {"painted_knot", "the torus knot with vertex colours, as glTF", makePaintedKnot},
    };
    return kShapes;
}

const PaintedShape* findPainted(std::string_view name)
{
    for (const PaintedShape& shape : paintedShapes())
        if (shape.name == name)
            return &shape;
    return nullptr;
}

} // namespace penumbra
