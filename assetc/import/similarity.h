// Transforms of nodes as the engine has them: rigid with a uniform scale. What of a matrix is more
// than that belongs into the mesh.
#pragma once

#include "shaders/shared/interop.h"

namespace penumbra {

struct Similarity {
    glm::dvec3 position{0};
    glm::dquat rotation{1, 0, 0, 0};
    double scale = 1; // > 0
};

// parentFromWorld * worldFromNode.
Similarity relativeTo(const Similarity& parent, const Similarity& node);

struct SplitTransform {
    Similarity similarity;
    glm::dmat3 rest{
        1.0}; // matrix = similarity * rest; the identity for a similarity without mirror
};

// `matrix` is affine and finite. A rest that is not the identity is rounded to 20 bits, so that
// equal nodes with rounding errors of their own get equal rests; the rigid part comes from the
// polar decomposition (Higham 1986), and is the translation alone where the matrix is flat.
SplitTransform splitTransform(const glm::dmat4& matrix);

} // namespace penumbra
