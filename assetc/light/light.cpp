#include "assetc/light.h"

#include "assetc/field_errors.h"
#include "assetc/light/flat_emitter.h"
#include "assetc/light/input.h"
#include "assetc/light/light_field.h"
#include "assetc/light/mesh_emitter.h"
#include "assetc/light/shape_mesh.h"
#include "assetc/light/sphere_emitter.h"
#include "assetc/light/surface.h"

#include <numbers>

namespace penumbra {

namespace {

using EmitterResult = Result<std::unique_ptr<Emitter>>;

// Radiance of a surface of `area` m² that emits alike in all directions of a half space.
Result<vec3> lambertianRadiance(const LightSpec& spec, double area)
{
    if (spec.unit == EmissionUnit::Radiance)
        return spec.emission;
    const vec3 radiance = spec.emission / static_cast<float>(std::numbers::pi * area);
    for (int c = 0; c < 3; ++c)
        if (!(radiance[c] <= kMaxRadiance))
            return Error{
                fmt::format("a radiance of {} W/(m² sr), at most {}; make the light weaker "
                            "or larger",
                            radiance[c], kMaxRadiance)};
    return radiance;
}

EmitterResult makeEmitter(const LightInput& input, const MeshAsset& mesh, std::uint32_t directions)
{
    const LightSpec& spec = input.spec;
    if (spec.shape == EmitterShape::Sphere || spec.shape == EmitterShape::Mesh) {
        const bool sphere = spec.shape == EmitterShape::Sphere;
        const double area = sphere ? 4 * std::numbers::pi * spec.radius * spec.radius
                                   : surfaceArea(mesh) * (spec.twoSided ? 2 : 1);
        const auto radiance = lambertianRadiance(spec, area);
        if (!radiance)
            return radiance.error();
        if (sphere)
            return EmitterResult(std::make_unique<SphereEmitter>(spec.radius, *radiance));
        return EmitterResult(std::make_unique<MeshEmitter>(
            mesh, *radiance, MeshEmitter::Options{spec.twoSided, directions}));
    }
    auto emitter = FlatEmitter::make(spec, input.texture ? &*input.texture : nullptr);
    if (!emitter)
        return emitter.error();
    return EmitterResult(std::make_unique<FlatEmitter>(std::move(*emitter)));
}

// Error: a reach that the shells cannot have.
Result<LightFieldOptions> fieldOptions(const LightSpec& spec, const LightOptions& options,
                                       float radius)
{
    LightFieldOptions field{options.shells, options.side};
    // Inside a sphere nothing is lit: the shells begin on its surface.
    field.innerRadius = spec.shape == EmitterShape::Sphere ? 1.0f : 0.2f;
    field.outerRadius = spec.reach > 0 ? spec.reach / radius : kLightOuterRadius;
    if (field.outerRadius < kMinLightReach || field.outerRadius > kMaxLightReach)
        return Error{fmt::format(
            "a reach of {} m; a light of bounding radius {} m can reach {} to {} m; set "
            "\"reach\" between them or leave it out",
            spec.reach, radius, kMinLightReach * radius, kMaxLightReach * radius)};
    return field;
}

// Nodes of an octahedral grid are at most this far apart, degrees.
float cellAngle(std::uint32_t side)
{
    return 180.0f * std::numbers::sqrt2_v<float> / static_cast<float>(side - 1);
}

std::vector<SelfVisibility> bakeSelfVisibility(const LightSpec& spec, const MeshAsset& mesh,
                                               Progress& progress)
{
    if (spec.shape == EmitterShape::Mesh) {
        BakeOptions self;
        self.field = false;
        return bakeMesh(mesh.positions, mesh.normals, mesh.indices, self, progress).selfVisibility;
    }
    SelfVisibility open; // convex: it hides nothing from itself
    open.fill(128);
    return std::vector<SelfVisibility>(mesh.positions.size(), open);
}

} // namespace

Result<CompiledLight> compileLight(const std::filesystem::path& source, const LightOptions& options,
                                   Progress& progress, SourceFiles* files)
{
    CompiledLight light;
    LightSpec& spec = light.spec;
    const std::string place = source.string();
    MeshAsset& mesh = light.asset.mesh;
    CompileReport& report = light.asset.report;
    if (const auto fits = checkFieldBytes(options.shells, options.side, 3, place); !fits)
        return fits.error();
    JsonProblems problems;
    auto input = [&] {
        const StageTimer timer(report.times, "import");
        return readLightInput(source, problems, files ? &files->asked : nullptr);
    }();
    if (!input)
        return joined(problems);
    if (files)
        if (const auto kept = files->refuseOverwrite(source); !kept)
            return kept.error();
    spec = input->spec;
    // The mesh that people see, as it is before cleaning.
    mesh = input->mesh ? std::move(input->mesh->mesh) : makeShapeMesh(spec);
    mesh.name = source.stem().string().substr(0, kMaxNameBytes);
    if (input->mesh)
        report.warnings = std::move(input->mesh->warnings);
    if (spec.shape == EmitterShape::Spot &&
        spec.outerAngle - spec.innerAngle < cellAngle(options.side))
        report.warnings.push_back(fmt::format(
            "the falloff of {:.1f} degrees is narrower than a cell of the field, {:.1f} "
            "degrees; raise --max-side",
            spec.outerAngle - spec.innerAngle, cellAngle(options.side)));
    const float white = paintLight(mesh, spec, input->texture ? &*input->texture : nullptr);
    const std::string meshPlace = input->mesh ? place + ": light.source" : place;
    if (const auto prepared = prepareMesh(light.asset, meshPlace, options.encode); !prepared)
        return prepared.error();
    {
        const StageTimer timer(report.times, "self-visibility");
        mesh.selfVisibility = bakeSelfVisibility(spec, mesh, progress);
    }

    const auto emitter = makeEmitter(*input, mesh, options.directions);
    if (!emitter)
        return fail(emitter.error(), place);
    light.power = (*emitter)->power();
    setEmission(mesh, white * (*emitter)->surfaceRadiance());
    if (!(light.power.r + light.power.g + light.power.b > 0))
        return Error{place + ": the light is black; give it a texture with a bright pixel"};
    const auto fieldSettings = fieldOptions(spec, options, (*emitter)->bounds().radius);
    if (!fieldSettings)
        return fail(fieldSettings.error(), place);
    FieldSamples field;
    std::vector<Probe> probes;
    {
        // What the light sends to the space around it.
        const StageTimer timer(report.times, "bake");
        field = bakeLightField(**emitter, *fieldSettings, progress);
        if (spec.shape == EmitterShape::Mesh)
            field.head.directions = options.directions;
        probes = probeLight(**emitter, field.head);
    }
    {
        const StageTimer timer(report.times, "adapt");
        const float brightest = brightestRadiance(field);
        if (options.adaptThreshold > 0)
            report.adapt = adaptShells(field, {options.adaptThreshold, brightest});
        mesh.field = quantiseField(field);
        if (brightest > 0)
            mesh.field->errors = measureRadianceErrors(field, *mesh.field, probes, brightest);
        else
            report.warnings.push_back("no place around the light is lit: check which way its "
                                      "triangles wind");
    }
    if (const auto encoded = encodeAsset(light.asset, place, options.encode); !encoded)
        return encoded.error();
    return light;
}

} // namespace penumbra
