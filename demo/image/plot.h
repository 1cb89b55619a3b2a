// Curves over two logarithmic axes, as a picture.
#pragma once

#include "demo/image/image.h"
#include "runtime/canvas.h"

#include <string>

namespace penumbra {

struct PlotCurve {
    std::string name; // in the legend
    Color color{};
    bool dashed = false;
    std::vector<vec2> points; // from left to right; both > 0 and on the axes, others are left out
};

struct Plot {
    std::string title, xLabel, yLabel;
    std::vector<float> xTicks; // at least two, rising; the axis goes from the first to the last
    vec2 yRange{0};            // ends of the y axis, > 0; 0: what the curves need
    std::vector<PlotCurve> curves;
};

// Sides of at least 320.
Image8 drawPlot(const Plot& plot, std::uint32_t width, std::uint32_t height);

Image8 imageOf(const Canvas& canvas);

} // namespace penumbra
