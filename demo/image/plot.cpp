#include "demo/image/plot.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <span>

namespace penumbra {

namespace {

constexpr Color kPaper{250, 250, 248}, kInk{40, 42, 46}, kGrid{222, 222, 220}, kFine{238, 238, 236};
constexpr int kLeft = 92, kRight = 28, kTop = 84, kLineHeight = 24;
constexpr int kLegendRow = 26, kLegendColumns = 2;
constexpr float kStroke = 1.5f, kMark = 4.5f; // half-width of a curve, radius of a point, pixels
constexpr float kDash = 7;                    // pixels on, and off

float distanceToSegment(vec2 p, vec2 a, vec2 b, float& along)
{
    const vec2 ab = b - a;
    const float t = clamp(dot(p - a, ab) / max(dot(ab, ab), 1e-12f), 0.0f, 1.0f);
    along = t * length(ab);
    return length(p - (a + t * ab));
}

// Of y, to whole decades or their halves, at least a half.
vec2 rangeOf(std::span<const PlotCurve> curves)
{
    float low = 1e30f, high = 0;
    for (const PlotCurve& curve : curves)
        for (const vec2 p : curve.points)
            if (p.x > 0 && p.y > 0) {
                low = std::min(low, p.y);
                high = std::max(high, p.y);
            }
    if (high <= 0)
        return {0.1f, 1};
    const float bottom = 0.5f * std::floor(2 * std::log10(low));
    const float top = std::max(0.5f * std::ceil(2 * std::log10(high)), bottom + 0.5f);
    return {std::pow(10.0f, bottom), std::pow(10.0f, top)};
}

class Drawing {
public:
    Drawing(const Plot& plot, int width, int height)
        : m_plot(plot), m_canvas(width, height, kPaper),
          m_bottom(height - 2 * kLineHeight - 28 - legendHeight())
    {
        m_x = {std::log10(plot.xTicks.front()), std::log10(plot.xTicks.back())};
        const vec2 range = plot.yRange.y > 0 ? plot.yRange : rangeOf(plot.curves);
        m_y = {std::log10(range.x), std::log10(range.y)};
    }

    Canvas draw()
    {
        drawAxes();
        for (const PlotCurve& curve : m_plot.curves)
            drawCurve(curve);
        drawLegend();
        return std::move(m_canvas);
    }

private:
    [[nodiscard]] int legendHeight() const
    {
        const auto rows =
            (static_cast<int>(m_plot.curves.size()) + kLegendColumns - 1) / kLegendColumns;
        return rows * kLegendRow;
    }

    [[nodiscard]] vec2 place(vec2 value) const
    {
        const float width = static_cast<float>(m_canvas.width() - kLeft - kRight);
        const float height = static_cast<float>(m_bottom - kTop);
        return {kLeft + width * (std::log10(value.x) - m_x.x) / (m_x.y - m_x.x),
                static_cast<float>(m_bottom) -
                    height * (std::log10(value.y) - m_y.x) / (m_y.y - m_y.x)};
    }

    void drawAxes()
    {
        const int right = m_canvas.width() - kRight;
        for (int decade = static_cast<int>(std::floor(m_y.x)); decade < m_y.y + 1; ++decade)
            for (int digit = 1; digit < 10; ++digit) {
                const float value = static_cast<float>(digit) * std::pow(10.0f, float(decade));
                const float at = std::log10(value);
                if (at < m_y.x - 1e-4f || at > m_y.y + 1e-4f)
                    continue;
                const int y = static_cast<int>(place({m_plot.xTicks[0], value}).y + 0.5f);
                m_canvas.fill(kLeft, y, right - kLeft, 1, digit == 1 ? kGrid : kFine);
                if (digit == 1 || digit == 2 || digit == 5)
                    textLeftOf(kLeft - 10, y, fmt::format("{:g}", value));
            }
        for (const float tick : m_plot.xTicks) {
            const int x = static_cast<int>(place({tick, 1}).x + 0.5f);
            const std::string label = fmt::format("{:g}", tick);
            m_canvas.fill(x, kTop, 1, m_bottom - kTop, kGrid);
            m_canvas.text(x - textWidth(label) / 2, m_bottom + 10, label, kInk);
        }
        m_canvas.fill(kLeft, kTop, 1, m_bottom - kTop, kInk);
        m_canvas.fill(kLeft, m_bottom, right - kLeft, 1, kInk);
        m_canvas.text(20, 18, m_plot.title, kInk);
        m_canvas.text(20, 18 + kLineHeight, m_plot.yLabel, kInk);
        m_canvas.text((kLeft + right - textWidth(m_plot.xLabel)) / 2, m_bottom + 10 + kLineHeight,
                      m_plot.xLabel, kInk);
    }

    void textLeftOf(int right, int middle, const std::string& text)
    {
        m_canvas.text(right - textWidth(text), middle - 7, text, kInk);
    }

    // Covers the pixels around with `color`, by how much of them lies inside.
    void blend(int x, int y, Color color, float cover)
    {
        if (cover <= 0 || x < 0 || y < 0 || x >= m_canvas.width() || y >= m_canvas.height())
            return;
        Color& pixel = m_canvas.at(x, y);
        for (std::size_t c = 0; c < 3; ++c)
            pixel[c] = static_cast<std::uint8_t>(
                mix(static_cast<float>(pixel[c]), static_cast<float>(color[c]), min(cover, 1.0f)) +
                0.5f);
    }

    // `start`: length of the curve before the segment, for dashes.
    void segment(vec2 a, vec2 b, Color color, bool dashed, float start)
    {
        const vec2 low = min(a, b) - (kStroke + 1), high = max(a, b) + (kStroke + 1);
        for (int y = static_cast<int>(low.y); y <= static_cast<int>(high.y); ++y)
            for (int x = static_cast<int>(low.x); x <= static_cast<int>(high.x); ++x) {
                float along = 0;
                const float distance = distanceToSegment(vec2(x, y) + 0.5f, a, b, along);
                if (!dashed || std::fmod(start + along, 2 * kDash) < kDash)
                    blend(x, y, color, kStroke + 0.5f - distance);
            }
    }

    void mark(vec2 at, Color color)
    {
        const int reach = static_cast<int>(kMark) + 2;
        for (int dy = -reach; dy <= reach; ++dy)
            for (int dx = -reach; dx <= reach; ++dx) {
                const int x = static_cast<int>(at.x) + dx, y = static_cast<int>(at.y) + dy;
                blend(x, y, color, kMark + 0.5f - length(vec2(x, y) + 0.5f - at));
            }
    }

    void drawCurve(const PlotCurve& curve)
    {
        float start = 0;
        const vec2* previous = nullptr;
        for (const vec2& point : curve.points) {
            if (point.x <= 0 || point.y <= 0 || std::log10(point.y) < m_y.x - 1e-3f ||
                std::log10(point.y) > m_y.y + 1e-3f) {
                previous = nullptr;
                continue;
            }
            const vec2 at = place(point);
            if (previous != nullptr) {
                segment(place(*previous), at, curve.color, curve.dashed, start);
                start += length(at - place(*previous));
            }
            if (!curve.dashed)
                mark(at, curve.color);
            previous = &point;
        }
    }

    void drawLegend()
    {
        const int top = m_canvas.height() - legendHeight() - 6;
        const int columnWidth = (m_canvas.width() - 40) / kLegendColumns;
        for (std::size_t i = 0; i < m_plot.curves.size(); ++i) {
            const PlotCurve& curve = m_plot.curves[i];
            const int x = 20 + static_cast<int>(i % kLegendColumns) * columnWidth;
            const int y = top + static_cast<int>(i / kLegendColumns) * kLegendRow;
            const auto middle = static_cast<float>(y + 7);
            segment({x, middle}, {x + 36, middle}, curve.color, curve.dashed, 0);
            if (!curve.dashed)
                mark({x + 18, middle}, curve.color);
            m_canvas.text(x + 46, y, curve.name, kInk);
        }
    }

    const Plot& m_plot;
    Canvas m_canvas;
    int m_bottom;
    vec2 m_x{0}, m_y{0}; // ends of the axes, decades
};

} // namespace

Image8 drawPlot(const Plot& plot, std::uint32_t width, std::uint32_t height)
{
    PENUMBRA_ASSERT(plot.xTicks.size() >= 2 && plot.xTicks.front() > 0 &&
                        plot.xTicks.front() < plot.xTicks.back() && width >= 320 && height >= 320,
                    "{} ticks, {} x {}", plot.xTicks.size(), width, height);
    return imageOf(Drawing(plot, static_cast<int>(width), static_cast<int>(height)).draw());
}

Image8 imageOf(const Canvas& canvas)
{
    Image8 image = makeImage(static_cast<std::uint32_t>(canvas.width()),
                             static_cast<std::uint32_t>(canvas.height()));
    for (std::size_t i = 0; i < canvas.pixels().size(); ++i)
        std::copy_n(canvas.pixels()[i].begin(), 3,
                    image.rgba.begin() + static_cast<std::ptrdiff_t>(4 * i));
    return image;
}

} // namespace penumbra
