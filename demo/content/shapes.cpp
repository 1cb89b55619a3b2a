#include "demo/content/shapes.h"

#include <algorithm>
#include <array>

namespace penumbra {

std::span<const ContentShape> contentShapes()
{
    static constexpr std::array kShapes{
        ContentShape{"ball", "a sphere", makeBall},
        ContentShape{"bowling_pin", "a ten-pin bowling pin, USBC profile", makeBowlingPin},
        ContentShape{"chess_pawn", "a Staunton pawn", makeChessPawn},
        ContentShape{"floor", "a plate of 96 x 96 cells, top at y = 0", [] { return makeFloor(); }},
        ContentShape{"floor_coarse", "the same plate, its top two triangles", makeCoarseFloor},
        ContentShape{"gear", "a spur gear with bore, hub and rim", makeGear},
        ContentShape{"hex_nut", "a chamfered nut with a helical thread", makeHexNut},
        ContentShape{"mug", "a mug with handle and inside", makeMug},
        ContentShape{"panel", "a thin box, the back of a flat light", makePanel},
        ContentShape{"rounded_cube", "a superellipsoid", makeRoundedCube},
        ContentShape{"spring", "a compression spring with closed ends", makeSpring},
        ContentShape{"teapot", "Newell's teapot", makeTeapot},
        ContentShape{"torus_knot", "the (2,3) torus knot", makeTorusKnot},
    };
    return kShapes;
}

const ContentShape* findShape(std::string_view name)
{
    const auto shapes = contentShapes();
    const auto found = std::find_if(shapes.begin(), shapes.end(),
                                    [&](const ContentShape& s) { return s.name == name; });
    return found == shapes.end() ? nullptr : &*found;
}

} // namespace penumbra
