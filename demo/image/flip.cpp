#include "demo/image/flip.h"

#include <algorithm>
#include <array>
#include <functional>
#include <numbers>

namespace penumbra {

namespace {

// Table 1 of the paper: the contrast sensitivity of each opponent channel as a sum of two
// Gaussians, sum_i a_i sqrt(pi / b_i) exp(-pi^2 d^2 / b_i), d in degrees.
struct Sensitivity {
    std::array<double, 2> a, b;
};
constexpr Sensitivity kAchromatic{{1.0, 0.0}, {0.0047, 1e-5}};
constexpr Sensitivity kRedGreen{{1.0, 0.0}, {0.0053, 1e-5}};
constexpr Sensitivity kBlueYellow{{34.1, 13.5}, {0.04, 0.025}};
constexpr double kWidestB = 0.04;
constexpr double kQc = 0.7, kPc = 0.4,
                 kPt = 0.95;            // section 4.1: exponent and remapping of the colour error
constexpr double kFeatureWidth = 0.082; // section 4.2: degrees, two standard deviations
constexpr double kQf = 0.5;             // section 4.2: exponent of the feature error

using Plane = std::vector<float>; // [height * width]

struct Size {
    int width, height;
};

struct Planes {
    Plane x, y, z;
};

// --- Colour
// ---------------------------------------------------------------------------------------------------------

const glm::dmat3& xyzFromRgb()
{
    // Columns: the primaries of sRGB; their sum is the white point D65.
    static const glm::dmat3 matrix(0.412386564, 0.212636822, 0.019330620, //
                                   0.357591491, 0.715182981, 0.119197164, //
                                   0.180450490, 0.072180197, 0.950372587);
    return matrix;
}

glm::dvec3 white()
{
    return xyzFromRgb() * glm::dvec3(1.0);
}

// YCxCz, linear in light (Flohr et al. 1993): what the eye's filters work on.
glm::dvec3 opponentFromRgb(glm::dvec3 rgb)
{
    const glm::dvec3 n = xyzFromRgb() * rgb / white();
    return {116.0 * n.y - 16.0, 500.0 * (n.x - n.y), 200.0 * (n.y - n.z)};
}

glm::dvec3 rgbFromOpponent(glm::dvec3 c)
{
    static const glm::dmat3 rgbFromXyz = glm::inverse(xyzFromRgb());
    const double y = (c.x + 16.0) / 116.0;
    return rgbFromXyz * (glm::dvec3(y + c.y / 500.0, y, y - c.z / 200.0) * white());
}

// CIE L*a*b* with the Hunt effect: differences of hue count less in the dark.
glm::dvec3 huntLabFromRgb(glm::dvec3 rgb)
{
    constexpr double kDelta = 6.0 / 29.0;
    glm::dvec3 f = xyzFromRgb() * rgb / white();
    for (int i = 0; i < 3; ++i)
        f[i] = f[i] > kDelta * kDelta * kDelta ? std::cbrt(f[i])
                                               : f[i] / (3.0 * kDelta * kDelta) + 4.0 / 29.0;
    const double lightness = 116.0 * f.y - 16.0;
    return {lightness, 0.01 * lightness * 500.0 * (f.x - f.y),
            0.01 * lightness * 200.0 * (f.y - f.z)};
}

double hyab(glm::dvec3 a, glm::dvec3 b)
{
    const glm::dvec3 d = a - b;
    return std::abs(d.x) + std::hypot(d.y, d.z);
}

// --- Filters; past the border the border's value holds
// ----------------------------------------------------------------

using Kernel = std::vector<float>; // [2 * radius + 1]

Kernel makeKernel(int radius, const std::function<double(double)>& weight)
{
    Kernel kernel;
    for (int i = -radius; i <= radius; ++i)
        kernel.push_back(static_cast<float>(weight(i)));
    return kernel;
}

double sum(const Kernel& kernel)
{
    double total = 0.0;
    for (const float w : kernel)
        total += w;
    return total;
}

// The positive weights sum to 1, the negative ones to -1.
Kernel normalizedSigned(Kernel kernel)
{
    double positive = 0.0, negative = 0.0;
    for (const float w : kernel)
        (w > 0.0f ? positive : negative) += std::abs(w);
    for (float& w : kernel)
        w = static_cast<float>(w / (w > 0.0f ? positive : negative));
    return kernel;
}

Plane convolveSeparable(const Plane& in, Size size, const Kernel& alongX, const Kernel& alongY)
{
    const int radiusX = static_cast<int>(alongX.size() / 2),
              radiusY = static_cast<int>(alongY.size() / 2);
    Plane rows(in.size()), out(in.size());
    std::vector<float> padded(size.width + 2 * radiusX);
    for (int y = 0; y < size.height; ++y) {
        const float* row = in.data() + std::size_t(y) * size.width;
        for (int x = 0; x < static_cast<int>(padded.size()); ++x)
            padded[x] = row[std::clamp(x - radiusX, 0, size.width - 1)];
        float* to = rows.data() + std::size_t(y) * size.width;
        for (std::size_t k = 0; k < alongX.size(); ++k)
            for (int x = 0; x < size.width; ++x)
                to[x] += alongX[alongX.size() - 1 - k] * padded[x + k];
    }
    for (int y = 0; y < size.height; ++y) {
        float* to = out.data() + std::size_t(y) * size.width;
        for (int k = -radiusY; k <= radiusY; ++k) {
            const float* from =
                rows.data() + std::size_t(std::clamp(y - k, 0, size.height - 1)) * size.width;
            for (int x = 0; x < size.width; ++x)
                to[x] += alongY[k + radiusY] * from[x];
        }
    }
    return out;
}

Plane filterSensitivity(const Plane& in, Size size, const Sensitivity& csf, double pixelsPerDegree)
{
    const double pi = std::numbers::pi;
    const int radius =
        static_cast<int>(std::ceil(3.0 * std::sqrt(kWidestB / (2.0 * pi * pi)) * pixelsPerDegree));
    std::array<Kernel, 2> kernels;
    std::array<double, 2> weights{};
    for (int i = 0; i < 2; ++i) {
        kernels[i] = makeKernel(radius, [&](double x) {
            const double d = x / pixelsPerDegree;
            return std::exp(-pi * pi * d * d / csf.b[i]);
        });
        const double mass = sum(kernels[i]);
        weights[i] = csf.a[i] * std::sqrt(pi / csf.b[i]) * mass * mass;
        for (float& w : kernels[i])
            w = static_cast<float>(w / mass);
    }
    Plane out(in.size());
    for (int i = 0; i < 2; ++i) {
        if (csf.a[i] == 0.0)
            continue;
        const Plane part = convolveSeparable(in, size, kernels[i], kernels[i]);
        const auto share = static_cast<float>(weights[i] / (weights[0] + weights[1]));
        for (std::size_t p = 0; p < out.size(); ++p)
            out[p] += share * part[p];
    }
    return out;
}

// --- The two pipelines of Fig. 2
// --------------------------------------------------------------------------------------

Planes opponentPlanes(const Image8& image)
{
    std::array<double, 256> linear{};
    for (int i = 0; i < 256; ++i)
        linear[i] = linearFromSrgb(static_cast<float>(i) / 255.0f);
    Planes planes;
    const std::size_t count = image.rgba.size() / 4;
    for (Plane* plane : {&planes.x, &planes.y, &planes.z})
        plane->resize(count);
    for (std::size_t p = 0; p < count; ++p) {
        const std::uint8_t* c = &image.rgba[4 * p];
        const glm::dvec3 opponent = opponentFromRgb({linear[c[0]], linear[c[1]], linear[c[2]]});
        planes.x[p] = static_cast<float>(opponent.x);
        planes.y[p] = static_cast<float>(opponent.y);
        planes.z[p] = static_cast<float>(opponent.z);
    }
    return planes;
}

std::vector<glm::dvec3> perceivedColors(const Planes& opponent, Size size, double pixelsPerDegree)
{
    const Plane y = filterSensitivity(opponent.x, size, kAchromatic, pixelsPerDegree);
    const Plane cx = filterSensitivity(opponent.y, size, kRedGreen, pixelsPerDegree);
    const Plane cz = filterSensitivity(opponent.z, size, kBlueYellow, pixelsPerDegree);
    std::vector<glm::dvec3> colors(y.size());
    for (std::size_t p = 0; p < colors.size(); ++p)
        colors[p] = huntLabFromRgb(
            clamp(rgbFromOpponent({y[p], cx[p], cz[p]}), glm::dvec3(0.0), glm::dvec3(1.0)));
    return colors;
}

double colorError(glm::dvec3 a, glm::dvec3 b)
{
    static const double most =
        std::pow(hyab(huntLabFromRgb({0, 1, 0}), huntLabFromRgb({0, 0, 1})), kQc);
    const double error = std::pow(hyab(a, b), kQc);
    const double knee = kPc * most;
    return error < knee ? error * kPt / knee : kPt + (error - knee) / (most - knee) * (1.0 - kPt);
}

struct Features {
    Plane edges, points; // magnitude of the first and of the second derivative of the brightness
};

Features features(const Plane& opponentY, Size size, double pixelsPerDegree)
{
    Plane brightness(opponentY.size());
    for (std::size_t p = 0; p < brightness.size(); ++p)
        brightness[p] = (opponentY[p] + 16.0f) / 116.0f;
    const double sigma = 0.5 * kFeatureWidth * pixelsPerDegree;
    const int radius = static_cast<int>(std::ceil(3.0 * sigma));
    const auto gauss = [&](double x) { return std::exp(-x * x / (2.0 * sigma * sigma)); };
    const Kernel smooth = normalizedSigned(makeKernel(radius, gauss));
    const Kernel edge =
        normalizedSigned(makeKernel(radius, [&](double x) { return -x * gauss(x); }));
    const Kernel point = normalizedSigned(
        makeKernel(radius, [&](double x) { return (x * x / (sigma * sigma) - 1.0) * gauss(x); }));
    const auto magnitude = [&](const Kernel& derivative) {
        const Plane x = convolveSeparable(brightness, size, derivative, smooth);
        Plane length = convolveSeparable(brightness, size, smooth, derivative);
        for (std::size_t p = 0; p < length.size(); ++p)
            length[p] = std::hypot(x[p], length[p]);
        return length;
    };
    return {magnitude(edge), magnitude(point)};
}

} // namespace

FlipResult flipMap(const Image8& reference, const Image8& test, double pixelsPerDegree)
{
    PENUMBRA_ASSERT(
        reference.width == test.width && reference.height == test.height && !reference.rgba.empty(),
        "{} x {} against {} x {}", reference.width, reference.height, test.width, test.height);
    PENUMBRA_ASSERT(pixelsPerDegree > 0.0, "{} pixels per degree", pixelsPerDegree);
    const Size size{static_cast<int>(reference.width), static_cast<int>(reference.height)};
    const Planes a = opponentPlanes(reference), b = opponentPlanes(test);
    const std::vector<glm::dvec3> colorA = perceivedColors(a, size, pixelsPerDegree);
    const std::vector<glm::dvec3> colorB = perceivedColors(b, size, pixelsPerDegree);
    const Features featuresA = features(a.x, size, pixelsPerDegree);
    const Features featuresB = features(b.x, size, pixelsPerDegree);
    FlipResult result;
    result.map.resize(colorA.size());
    double total = 0.0;
    for (std::size_t p = 0; p < colorA.size(); ++p) {
        const double difference = std::max(std::abs(featuresA.edges[p] - featuresB.edges[p]),
                                           std::abs(featuresA.points[p] - featuresB.points[p]));
        const double featureError = std::pow(difference / std::numbers::sqrt2, kQf);
        const double error = std::pow(colorError(colorA[p], colorB[p]), 1.0 - featureError);
        result.map[p] = static_cast<float>(std::clamp(error, 0.0, 1.0));
        total += result.map[p];
    }
    result.mean = total / static_cast<double>(colorA.size());
    return result;
}

double flip(const Image8& reference, const Image8& test, double pixelsPerDegree)
{
    return flipMap(reference, test, pixelsPerDegree).mean;
}

} // namespace penumbra
