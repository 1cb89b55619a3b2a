// Collects closed surfaces and turns them into one ContentMesh. Nearly every shape is a skin over
// rings of points: a lathe's rings are its circles, a tube's rings its cross-sections, a gear's
// rings its teeth outlines.
#pragma once

#include "demo/content/content_mesh.h"

#include <array>
#include <span>
#include <vector>

namespace penumbra {

using Ring = std::vector<vec3>;

class MeshBuilder {
public:
    // A closed surface over `rings`, which all have the same number of points, >= 3; each ring is a
    // closed loop. `looped`: the last ring joins the first, as in a torus. Otherwise both ends must
    // be closed by a pole, that is, a ring of one point. The side that faces out follows from the
    // volume, so ring order does not matter.
    void addSkin(std::span<const Ring> rings, bool looped);

    // For surfaces that are no skins. Triangles must be counter-clockwise seen from outside.
    std::uint32_t addVertex(vec3 position);
    void addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);

    enum class Origin { CentreOfMass, AsBuilt };

    // Normals are the angle-weighted mean of the faces around a vertex (Thürmer and Wüthrich 1998),
    // split along edges where faces meet at more than `creaseDegrees`. Vertices keep the order in
    // which they were added.
    ContentMesh finish(std::string name, float creaseDegrees,
                       Origin origin = Origin::CentreOfMass) const;

private:
    using Triangle = std::array<std::uint32_t, 3>;

    void addQuad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);
    float signedVolume(std::size_t firstTriangle) const; // m³, times the sign of the orientation
    vec3 centreOfMass() const;                           // uniform density; overlaps count twice

    std::vector<vec3> m_positions;
    std::vector<Triangle> m_triangles;
};

// `sides` points on the ellipse centre + cos(a) axisX + sin(a) axisY.
Ring ellipseRing(vec3 centre, vec3 axisX, vec3 axisY, int sides);

} // namespace penumbra
