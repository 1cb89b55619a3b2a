// `assetc light`: what the stored bytes say at a receiver, against closed forms.
#include "assetc/light.h"
#include "assetc/light/shape_mesh.h"
#include "assets/mesh_codec.h"
#include "tests/assetc/light_field_reader.h"
#include "tests/support/temporary_folder.h"

#include <array>
#include <numbers>
#include <random>
#include <tbb/global_control.h>

namespace penumbra {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;

class Light : public testing::Test {
protected:
    CompiledLight compile(const std::string& spec, const LightOptions& options = {})
    {
        Progress progress("test");
        auto light = compileLight(folder.write("light.json", spec), options, progress);
        EXPECT_TRUE(light) << light.error().message;
        return std::move(*light);
    }

    // As a reader of the file sees it.
    MeshAsset stored(const std::string& spec, const LightOptions& options = {})
    {
        auto mesh = decodeMeshAsset(compile(spec, options).asset.bytes);
        EXPECT_TRUE(mesh) << mesh.error().message;
        return std::move(*mesh);
    }

    TemporaryFolder folder;
};

struct Receiver {
    vec3 position, normal;
};

vec3 randomDirection(std::mt19937& random)
{
    std::normal_distribution<float> normal;
    return normalize(vec3(normal(random), normal(random), normal(random)));
}

// In the half space z > 0, at least `elevation` (sine) above the plane; the normal is at most 60
// degrees off the centre and sees all of `corners` above its horizon.
Receiver randomReceiver(std::mt19937& random, float distance, float elevation,
                        const std::vector<vec3>& corners)
{
    for (;;) {
        Receiver r{distance * randomDirection(random), randomDirection(random)};
        bool good =
            r.position.z > elevation * distance && dot(r.normal, normalize(-r.position)) > 0.5f;
        for (const vec3 corner : corners)
            good = good && dot(r.normal, corner - r.position) > 0;
        if (good)
            return r;
    }
}

// Integral of L(w) w over a rectangle in z = 0 at a place above it: sums over the corners of the
// form factors of a differential element and a rectangle, parallel (z) and perpendicular (x, y).
// Howell, "A catalog of radiation heat transfer configuration factors", C-11 and C-12.
vec3 rectangleIrradiance(vec2 size, float radiance, vec3 p)
{
    const double h = p.z;
    const auto corner = [&](double x, double y) {
        const double rx = std::hypot(x, h), ry = std::hypot(y, h);
        const double ax = std::atan(y / rx) / rx, ay = std::atan(x / ry) / ry;
        return glm::dvec3(-h * ax, -h * ay, -(x * ax + y * ay)) * 0.5;
    };
    const double x0 = -0.5 * size.x - p.x, x1 = 0.5 * size.x - p.x;
    const double y0 = -0.5 * size.y - p.y, y1 = 0.5 * size.y - p.y;
    return vec3((corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0)) *
                static_cast<double>(radiance));
}

// Flux through a sphere of `radius` around the origin, W.
float fluxThrough(const LightFieldReader& reader, float radius, std::size_t channel)
{
    constexpr int kPlaces = 4000;
    double sum = 0;
    for (int i = 0; i < kPlaces; ++i) {
        const float z = 1 - (static_cast<float>(i) + 0.5f) * 2 / kPlaces;
        const float angle = 2.39996323f * static_cast<float>(i), s = std::sqrt(1 - z * z);
        const vec3 d(s * std::cos(angle), s * std::sin(angle), z);
        sum -= dot(reader.irradianceVector(radius * d, channel), d);
    }
    return static_cast<float>(sum / kPlaces * 4 * kPi * radius * radius);
}

} // namespace

TEST_F(Light, SphereIrradianceIsTheClosedForm)
{
    const MeshAsset mesh =
        stored(R"({"version":1,"type":"sphere","radius":0.25,"radiance":[10,5,1]})");
    const LightFieldReader reader(*mesh.field);
    std::mt19937 random(1);
    float worst = 0;
    for (int i = 0; i < 20; ++i) {
        const float distance = 0.25f * 1.3f * std::pow(30.0f, static_cast<float>(i) / 19);
        const float horizon = 0.25f / distance;
        Receiver r{};
        do {
            r = {distance * randomDirection(random), randomDirection(random)};
        } while (-dot(r.normal, r.position) / distance < std::max(horizon, 0.5f));
        const float cosine = -dot(r.normal, r.position) / distance;
        const float truth = kPi * 10 * horizon * horizon * cosine;
        const float error =
            std::abs(dot(reader.irradianceVector(r.position), r.normal) / truth - 1);
        EXPECT_LE(error, 0.02f) << "distance " << distance << " m";
        worst = std::max(worst, error);
    }
    RecordProperty("worst", std::to_string(worst));
}

// On the surface half the sky is the light, from everywhere alike: pi L, one byte per coefficient
// 0.
TEST_F(Light, SphereIsEvenOnItsSurface)
{
    const MeshAsset mesh =
        stored(R"({"version":1,"type":"sphere","radius":0.1,"radiance":[10,10,10]})");
    const LightFieldReader reader(*mesh.field);
    std::mt19937 random(2);
    for (int i = 0; i < 20; ++i)
        EXPECT_NEAR(reader.radiance(0.1f * randomDirection(random)).c[0], 10 * std::sqrt(kPi),
                    0.02f * 10 * std::sqrt(kPi));
}

TEST_F(Light, RectangleIrradianceIsTheClosedForm)
{
    const vec2 size(2, 1);
    const MeshAsset mesh =
        stored(R"({"version":1,"type":"rectangle","size":[2,1],"radiance":[3,3,3]})");
    const LightFieldReader reader(*mesh.field);
    std::vector<vec3> corners;
    for (const float x : {-1.0f, 1.0f})
        for (const float y : {-0.5f, 0.5f})
            corners.emplace_back(x, y, 0);
    std::mt19937 random(2);
    float worst = 0;
    for (int i = 0; i < 20; ++i) {
        const float distance = 0.9f * std::pow(40.0f, static_cast<float>(i) / 19);
        Receiver r = randomReceiver(random, distance, 0.5f, corners);
        if (i % 2 == 0)
            r.normal = vec3(0, 0, -1); // parallel to the light
        const float truth = dot(rectangleIrradiance(size, 3, r.position), r.normal);
        const float error =
            std::abs(dot(reader.irradianceVector(r.position), r.normal) / truth - 1);
        EXPECT_LE(error, 0.02f) << "place " << i << ", distance " << distance << " m";
        worst = std::max(worst, error);
    }
    RecordProperty("worst", std::to_string(worst));
}

// What leaves the surface arrives on a sphere around it.
TEST_F(Light, FluxIsThePower)
{
    folder.write("half.hdr", std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n") +
                                 std::string("\x80\x80\x80\x82\x40\x40\x40\x80", 8)); // 2 and 1/4
    const std::array<std::string, 5> shapes = {
        R"("type":"sphere","radius":0.3)", R"("type":"rectangle","size":[2,1])",
        R"("type":"disc","radius":0.5,"texture":"half.hdr")",
        R"("type":"rectangle","size":[1,1],"twoSided":true)",
        R"("type":"spot","radius":0.1,"innerAngle":25,"outerAngle":50)"};
    for (const std::string& shape : shapes) {
        const MeshAsset mesh =
            stored("{\"version\":1,\"power\":[60,30,90]," + shape + "}", {16, 65, 64});
        const LightFieldReader reader(*mesh.field);
        const vec3 power(60, 30, 90);
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(fluxThrough(reader, 6 * mesh.field->radius, c) / power[static_cast<int>(c)],
                        1, 0.02)
                << shape << " channel " << c;
    }
}

TEST_F(Light, PowerIsReported)
{
    const CompiledLight disc = compile(
        R"({"version":1,"type":"disc","radius":2,"twoSided":true,"radiance":[1,2,3]})", {4, 9, 64});
    EXPECT_NEAR(disc.power.g, 2 * 2 * kPi * kPi * 4, 1e-3); // L pi A, two sides
    const CompiledLight spot = compile(
        R"({"version":1,"type":"spot","radius":1,"innerAngle":0,"outerAngle":60,"intensity":[1,2,3]})",
        {4, 9, 64});
    EXPECT_NEAR(spot.power.b, 3 * 2 * kPi * 0.5 / 3, 1e-4); // int (2c - 1)^2 dc = 1/6
}

// PNG of 2 x 1 pixels: red, and green of sRGB 188, linear 0.5029.
TEST_F(Light, TexturesAreSeenFromTheFrontAsTheyAre)
{
    const unsigned char png[] = {
        137, 80,  78,  71,  13, 10,  26,  10, 0,   0,   0,   13,  73,  72,  68,  82, 0,  0,
        0,   2,   0,   0,   0,  1,   8,   2,  0,   0,   0,   123, 64,  232, 221, 0,  0,  0,
        15,  73,  68,  65,  84, 120, 218, 99, 248, 207, 192, 192, 176, 135, 1,   0,  7,  121,
        1,   188, 207, 197, 82, 188, 0,   0,  0,   0,   73,  69,  78,  68,  174, 66, 96, 130};
    folder.write("a.png", std::string(reinterpret_cast<const char*>(png), sizeof(png)));
    folder.write("b.hdr", std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 1\n") +
                              std::string("\x80\x80\x80\x82\x00\x00\x00\x00", 8)); // 2 above 0
    const LightOptions options{16, 17, 64};
    for (const char* shape :
         {R"("type":"rectangle","size":[2,2])", R"("type":"disc","radius":1)"}) {
        const MeshAsset wide =
            stored(fmt::format(R"({{"version":1,{},"radiance":[1,1,1],"texture":"a.png"}})", shape),
                   options);
        const LightFieldReader sides(*wide.field);
        const vec3 red = sides.irradianceVector(vec3(0, 0, 1), 0);
        const vec3 green = sides.irradianceVector(vec3(0, 0, 1), 1);
        EXPECT_LT(red.x, -0.1f) << shape; // who looks along -z with +y up has -x on the left
        EXPECT_NEAR(green.x / red.x, -0.5029f, 0.05f) << shape;
        EXPECT_NEAR(red.y, 0, 0.02f) << shape;
        EXPECT_EQ(length(sides.irradianceVector(vec3(0, 0, 1), 2)), 0) << shape;

        const MeshAsset high =
            stored(fmt::format(R"({{"version":1,{},"radiance":[3,3,3],"texture":"b.hdr"}})", shape),
                   options);
        const vec3 top = LightFieldReader(*high.field).irradianceVector(vec3(0, 0, 1));
        EXPECT_GT(top.y, 0.5f) << shape; // row 0 of the picture at +y
        EXPECT_NEAR(top.x, 0, 0.05f) << shape;
    }
}

// Far away a spot is KHR_lights_punctual's: I(a) = I_0 clamp((cos a - cos o) / (cos i - cos o))^2.
TEST_F(Light, SpotIsFullInsideAndDarkOutside)
{
    const MeshAsset mesh = stored(
        R"({"version":1,"type":"spot","radius":0.1,"innerAngle":20,"outerAngle":50,"intensity":[5,5,5]})");
    const LightFieldReader reader(*mesh.field);
    const float distance = 3;
    for (const float degrees :
         {0.0f, 5.0f, 10.0f, 15.0f, 25.0f, 30.0f, 35.0f, 60.0f, 90.0f, 170.0f}) {
        const auto cosine = [](float d) { return std::cos(d * kPi / 180); };
        const float t =
            std::clamp((cosine(degrees) - cosine(50)) / (cosine(20) - cosine(50)), 0.0f, 1.0f);
        const vec3 d(std::sin(degrees * kPi / 180) * 0.6f, std::sin(degrees * kPi / 180) * 0.8f,
                     cosine(degrees));
        const float irradiance = -dot(reader.irradianceVector(distance * d), d);
        EXPECT_NEAR(irradiance, 5 * t * t / (distance * distance), 0.02f * 5 / 9) << degrees;
    }
}

TEST_F(Light, TwoSidedShinesBothWays)
{
    const LightOptions options{16, 33, 64};
    const std::string disc = R"({"version":1,"type":"disc","radius":1,"radiance":[1,1,1])";
    const MeshAsset one = stored(disc + "}", options);
    const MeshAsset two = stored(disc + R"(,"twoSided":true})", options);
    EXPECT_EQ(two.positions.size(), 2 * one.positions.size());
    const LightFieldReader oneReader(*one.field), twoReader(*two.field);
    const vec3 front(0.4f, 0.3f, 2), back(0.4f, 0.3f, -2);
    EXPECT_LT(oneReader.irradianceVector(front).z, -0.3f);
    EXPECT_EQ(length(oneReader.irradianceVector(back)), 0);
    EXPECT_NEAR(twoReader.irradianceVector(front).z, oneReader.irradianceVector(front).z, 0.01f);
    EXPECT_NEAR(twoReader.irradianceVector(back).z, -twoReader.irradianceVector(front).z, 0.005f);
}

namespace {

std::string objText(const MeshAsset& mesh, float scale)
{
    std::string text;
    for (const vec3 p : mesh.positions)
        text += fmt::format("v {} {} {}\n", p.x * scale, p.y * scale, p.z * scale);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        text += fmt::format("f {} {} {}\n", mesh.indices[i] + 1, mesh.indices[i + 1] + 1,
                            mesh.indices[i + 2] + 1);
    return text;
}

} // namespace

TEST_F(Light, MeshOfASphereShinesAsTheSphere)
{
    folder.write("ball.obj", objText(makeIcosphere(4), 0.5f));
    const MeshAsset mesh = stored(
        R"({"version":1,"type":"mesh","source":"ball.obj","radiance":[10,10,10]})", {28, 33, 512});
    const LightFieldReader reader(*mesh.field);
    std::mt19937 random(3);
    for (int i = 0; i < 20; ++i) {
        const float distance = 0.5f * 1.4f * std::pow(25.0f, static_cast<float>(i) / 19);
        const vec3 d = randomDirection(random);
        const vec3 truth = -d * (kPi * 10 * 0.25f / (distance * distance));
        EXPECT_LE(length(reader.irradianceVector(distance * d) - truth), 0.02f * length(truth))
            << "distance " << distance << " m";
    }
    // Inside, only back faces are seen.
    EXPECT_EQ(length(reader.irradianceVector(vec3(0.2f, 0.1f, 0))), 0);
}

// Two squares one behind the other, both looking along +z: from far in front the first hides the
// second, from a place between them the second is seen alone.
TEST_F(Light, MeshHidesItself)
{
    folder.write("two.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
                            "v -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
                            "f 1 2 3 4\nf 5 6 7 8\n");
    const MeshAsset mesh = stored(
        R"({"version":1,"type":"mesh","source":"two.obj","radiance":[2,2,2]})", {32, 33, 1024});
    const LightFieldReader reader(*mesh.field);
    for (const float z : {4.0f, 8.0f, 16.0f}) {
        const float truth = rectangleIrradiance(vec2(2), 2, vec3(0, 0, z - 1)).z;
        EXPECT_NEAR(reader.irradianceVector(vec3(0, 0, z)).z / truth, 1, 0.02) << z;
    }
    const float between = rectangleIrradiance(vec2(2), 2, vec3(0.1f, 0, 0.75f)).z;
    EXPECT_NEAR(reader.irradianceVector(vec3(0.1f, 0, 0.75f)).z / between, 1, 0.05);
    EXPECT_NEAR(reader.irradianceVector(vec3(0, 0, -5)).z, 0, 1e-3);
}

TEST_F(Light, SameBytesAtAnyThreadCount)
{
    folder.write("ball.obj", objText(makeIcosphere(3), 1));
    for (const char* shape : {R"("type":"mesh","source":"ball.obj","twoSided":true)",
                              R"("type":"spot","radius":1,"innerAngle":0,"outerAngle":40)"}) {
        const std::string spec = fmt::format(R"({{"version":1,"radiance":[1,2,3],{}}})", shape);
        std::vector<std::vector<std::byte>> bytes;
        for (const std::size_t threads : {1, 2, 3}) {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
            bytes.push_back(compile(spec, {8, 17, 256}).asset.bytes);
        }
        EXPECT_EQ(bytes[0], bytes[1]) << shape;
        EXPECT_EQ(bytes[0], bytes[2]) << shape;
    }
}

// The threshold is a part of the light: it means the same for a strong and a weak one.
TEST_F(Light, ThresholdIsRelative)
{
    const LightOptions options{16, 33, 64, 0.2f};
    const auto sides = [&](const char* radiance) {
        return stored(
                   fmt::format(R"({{"version":1,"type":"rectangle","size":[1,1],"radiance":{}}})",
                               radiance),
                   options)
            .field->shellSides;
    };
    const std::vector<std::uint16_t> weak = sides("[0.001,0.001,0.001]");
    EXPECT_EQ(weak, sides("[1000,1000,1000]"));
    EXPECT_LT(weak.back(), 33);
}

TEST_F(Light, ReachMovesTheLastShell)
{
    const MeshAsset mesh =
        stored(R"({"version":1,"type":"sphere","radius":0.5,"radiance":[1,1,1],"reach":100})",
               {32, 9, 64});
    EXPECT_FLOAT_EQ(mesh.field->outerRadius, 200);
    const vec3 p(0, 60, 0);
    EXPECT_NEAR(LightFieldReader(*mesh.field).irradianceVector(p).y / (-kPi * 0.25f / 3600), 1,
                0.02);
}

// The stored error against the closed form of a sphere, c_0 = 2 pi L (1 - cos a) Y_0 and so on by
// rotation about the axis: c_l = 2 pi L integral P_l, in the unit of the asset's format.
TEST_F(Light, ErrorsAreThoseOfTheClosedForm)
{
    const MeshAsset mesh =
        stored(R"({"version":1,"type":"sphere","radius":0.5,"radiance":[4,4,4]})", {12, 17, 64});
    ASSERT_TRUE(mesh.field->errors);
    const FieldErrors& errors = *mesh.field->errors;
    const LightFieldReader reader(*mesh.field);
    std::mt19937 random(4);
    const auto exact = [](vec3 p) {
        const float sine = 0.5f / length(p), x = std::sqrt(1 - sine * sine);
        // Integrals of the Legendre polynomials over the cap, without what rounding costs.
        const float cap = sine * sine / (1 + x);
        const std::array<float, 4> integral = {cap, sine * sine / 2, x * sine * sine / 2,
                                               (5 * x * x - 1) * sine * sine / 8};
        Sh4 basis = shBasis(normalize(-p));
        for (int k = 0; k < 16; ++k)
            basis.c[k] *= 2 * kPi * 4 * integral[k < 1 ? 0 : k < 4 ? 1 : k < 9 ? 2 : 3];
        return basis;
    };
    // Brightest: on the surface, half of all directions; g(1) = 1 / 1.25.
    const float unit = 4 * 0.5f * 1.25f;
    double squares = 0;
    constexpr int kPoints = 4000;
    for (int i = 0; i < kPoints; ++i) {
        // Even between the shells, but for the last interval, which readers fade.
        const float t = (static_cast<float>(i) + 0.5f) / kPoints * (10.0f / 11);
        const float r = std::pow(64.0f, t);
        const vec3 p = 0.5f * r * randomDirection(random);
        const Sh4 a = exact(p), b = reader.radiance(p);
        for (int k = 0; k < 16; ++k) {
            const double d = (a.c[k] - b.c[k]) / (unit * fieldDecay(r * r));
            squares += d * d / (4 * kPi);
        }
    }
    // The stored one has that interval as well, which adds little to the sum.
    const double rms = std::sqrt(squares / kPoints * 10 / 11);
    RecordProperty("rms", std::to_string(rms));
    EXPECT_GE(errors.points, 4096u);
    EXPECT_NEAR(errors.total.rms / rms, 1, 0.05) << rms;
    EXPECT_EQ(errors.directions.rms, 0);
    EXPECT_EQ(errors.bandLimit.rms, 0);
}

// A part of the light: a strong one has the errors of a weak one. Finer bakes have smaller ones.
TEST_F(Light, ErrorsAreRelativeAndFallWithTheBake)
{
    const auto errors = [&](const char* radiance, const LightOptions& options) {
        return *stored(fmt::format(R"({{"version":1,"type":"sphere","radius":1,"radiance":{}}})",
                                   radiance),
                       options)
                    .field->errors;
    };
    const FieldErrors coarse = errors("[1,2,3]", {8, 17, 64, 0});
    const FieldErrors strong = errors("[1000,2000,3000]", {8, 17, 64, 0});
    EXPECT_NEAR(strong.total.rms / coarse.total.rms, 1, 1e-3);
    EXPECT_LT(errors("[1,2,3]", {8, 33, 64, 0}).angular.rms, 0.7f * coarse.angular.rms);
    EXPECT_LT(errors("[1,2,3]", {15, 17, 64, 0}).radial.rms, 0.5f * coarse.radial.rms);
}

TEST_F(Light, NoiseOfRaysIsInTheErrors)
{
    folder.write("ball.obj", objText(makeIcosphere(2), 1));
    const auto noise = [&](std::uint32_t directions) {
        return stored(R"({"version":1,"type":"mesh","source":"ball.obj","radiance":[1,1,1]})",
                      {6, 9, directions})
            .field->errors->directions.rms;
    };
    const float few = noise(64), many = noise(1024);
    EXPECT_GT(few, 0);
    EXPECT_LT(many, 0.5f * few);
}

// A light's errors are parts of its own brightness, whatever that is: 2^-70 scales without
// rounding.
TEST_F(Light, ErrorsDoNotDependOnTheUnit)
{
    LightOptions options;
    options.shells = 16;
    options.side = 33;
    const std::string start = R"({"version":1,"type":"disc","radius":1,"radiance":)";
    const CompiledLight one = compile(start + "[1,0.5,0.25]}", options);
    const CompiledLight faint = compile(
        start + "[8.470329472543003e-22,4.2351647362715017e-22,2.1175823681357508e-22]}", options);
    const FieldErrors a = *one.asset.mesh.field->errors, b = *faint.asset.mesh.field->errors;
    EXPECT_GT(a.total.rms, 1e-4f);
    for (const auto& [left, right] : {std::pair{a.total, b.total},
                                      {a.angular, b.angular},
                                      {a.radial, b.radial},
                                      {a.quantisation, b.quantisation}}) {
        EXPECT_NEAR(left.rms, right.rms, 1e-3f * left.rms);
        EXPECT_NEAR(left.max, right.max, 1e-3f * left.max);
    }
    // As is what adaptation reports, which stays below its threshold.
    ASSERT_TRUE(one.asset.report.adapt && faint.asset.report.adapt);
    EXPECT_GT(one.asset.report.adapt->worst, 0);
    EXPECT_LT(one.asset.report.adapt->worst, options.adaptThreshold);
    EXPECT_NEAR(one.asset.report.adapt->worst, faint.asset.report.adapt->worst, 1e-5f);
}

} // namespace penumbra
