#include "assetc/import/similarity.h"

#include <algorithm>

namespace penumbra {

namespace {

using glm::dmat3, glm::dvec3;

double largestEntry(const dmat3& m)
{
    double largest = 0;
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
            largest = std::max(largest, std::abs(m[c][r]));
    return largest;
}

// The orthogonal factor of a regular matrix: X becomes (X + X^-T) / 2, which converges
// quadratically.
dmat3 orthogonalFactor(dmat3 x)
{
    x /= largestEntry(x);
    for (int step = 0; step < 100; ++step) {
        const dmat3 next = 0.5 * (x + glm::transpose(glm::inverse(x)));
        const double change = largestEntry(next - x);
        x = next;
        if (change < 1e-15)
            break;
    }
    return x;
}

} // namespace

Similarity relativeTo(const Similarity& parent, const Similarity& node)
{
    const glm::dquat back = glm::conjugate(parent.rotation);
    return {back * (node.position - parent.position) / parent.scale,
            glm::normalize(back * node.rotation), node.scale / parent.scale};
}

SplitTransform splitTransform(const glm::dmat4& matrix)
{
    SplitTransform split;
    split.similarity.position = dvec3(matrix[3]);
    const dmat3 linear(matrix);
    const double size = largestEntry(linear);
    const double volume = size > 0 ? glm::determinant(linear / size) : 0;
    dmat3 rotation(1.0);
    if (std::abs(volume) > 1e-9) {
        rotation = orthogonalFactor(linear) * (volume < 0 ? -1.0 : 1.0);
        split.similarity.rotation = glm::normalize(glm::quat_cast(rotation));
    }
    const dmat3 stretch = glm::transpose(rotation) * linear;
    const double scale = (stretch[0][0] + stretch[1][1] + stretch[2][2]) / 3;
    // Exporters write matrices with 6 digits.
    if (scale > 0 && volume > 1e-9 && largestEntry(stretch - scale * dmat3(1.0)) < 1e-4 * scale) {
        split.similarity.scale = scale;
        return split;
    }
    const double step = size > 0 ? std::exp2(std::floor(std::log2(size)) - 20) : 1;
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
            split.rest[c][r] = std::round(stretch[c][r] / step) * step;
    return split;
}

} // namespace penumbra
