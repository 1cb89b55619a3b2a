// The GPU's struct offsets, read from SPIR-V, against the C++ compiler's.
#include "runtime/vk/shader_code.h"
#include "shaders/shared/instance.h"
#include "shaders/shared/surface.h"
#include "shaders/shared/transfer.h"
#include "tests/support/spirv_offsets.h"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

#define EXPECT_SAME_OFFSET(gpu, Type, member)                                                      \
    EXPECT_EQ((gpu).offset(#member), offsetof(Type, member))

TEST(Layout, InstanceInputAndField)
{
    const SpirvStruct input = spirvStruct(shaderCode("instance_update.comp"), "InstanceInput");
    EXPECT_SAME_OFFSET(input, InstanceInput, scale);
    EXPECT_SAME_OFFSET(input, InstanceInput, rotation);
    EXPECT_SAME_OFFSET(input, InstanceInput, albedo);
    EXPECT_SAME_OFFSET(input, InstanceInput, glossFraction);
    EXPECT_SAME_OFFSET(input, InstanceInput, field);
    EXPECT_SAME_OFFSET(input, InstanceInput, firstDraw);
    EXPECT_SAME_OFFSET(input, InstanceInput, drawCount);
    EXPECT_SAME_OFFSET(input, InstanceInput, hides);
    EXPECT_EQ(input.arrayStride, sizeof(InstanceInput));
    const SpirvStruct field = spirvStruct(shaderCode("instance_update.comp"), "FieldInput");
    EXPECT_SAME_OFFSET(field, FieldInput, radius);
    EXPECT_SAME_OFFSET(field, FieldInput, bandScale);
    EXPECT_SAME_OFFSET(field, FieldInput, inscribed);
    EXPECT_SAME_OFFSET(field, FieldInput, firstSample);
    EXPECT_SAME_OFFSET(field, FieldInput, outerRadius);
    EXPECT_EQ(field.arrayStride, sizeof(FieldInput));
}

TEST(Layout, GpuInstance)
{
    const SpirvStruct g = spirvStruct(shaderCode("instance_update.comp"), "GpuInstance");
    EXPECT_SAME_OFFSET(g, GpuInstance, gammaShells);
    EXPECT_SAME_OFFSET(g, GpuInstance, grid);
    EXPECT_SAME_OFFSET(g, GpuInstance, worldFromObject0);
    EXPECT_SAME_OFFSET(g, GpuInstance, material1);
    EXPECT_SAME_OFFSET(g, GpuInstance, inscribed);
    EXPECT_EQ(g.arrayStride, sizeof(GpuInstance));
    EXPECT_EQ(spirvStruct(shaderCode("instance_update.comp"), "DenseRotation").arrayStride,
              sizeof(DenseRotation));
}

TEST(Layout, ClustersAndResults)
{
    EXPECT_EQ(spirvStruct(shaderCode("cluster_cull.comp"), "ClusterBounds").arrayStride,
              sizeof(ClusterBounds));
    EXPECT_EQ(spirvStruct(shaderCode("cluster_cull.comp"), "SceneCluster").arrayStride,
              sizeof(SceneCluster));
    const SpirvStruct cull = spirvStruct(shaderCode("cluster_cull.comp"), "CullResult");
    EXPECT_SAME_OFFSET(cull, CullResult, combineGroups);
    EXPECT_SAME_OFFSET(cull, CullResult, pairs);
    EXPECT_EQ(spirvStruct(shaderCode("combine_literal.comp"), "ReceiverTexels").arrayStride,
              sizeof(ReceiverTexels));
}

TEST(Layout, SurfacePush)
{
    const SpirvStruct push = spirvStruct(shaderCode("raster_surface.frag"), "SurfacePush");
    EXPECT_SAME_OFFSET(push, SurfacePush, alpha);
    EXPECT_SAME_OFFSET(push, SurfacePush, emission);
    EXPECT_SAME_OFFSET(push, SurfacePush, alphaCutoff);
}

TEST(Layout, FrameConstants)
{
    const SpirvStruct frame = spirvStruct(shaderCode("cluster_cull.comp"), "FrameConstants");
    EXPECT_SAME_OFFSET(frame, FrameConstants, worldFromClip);
    EXPECT_SAME_OFFSET(frame, FrameConstants, eye);
    EXPECT_SAME_OFFSET(frame, FrameConstants, frustum);
    EXPECT_SAME_OFFSET(frame, FrameConstants, light);
    EXPECT_SAME_OFFSET(frame, FrameConstants, skyRotation);
    EXPECT_SAME_OFFSET(frame, FrameConstants, clusterCount);
    EXPECT_SAME_OFFSET(frame, FrameConstants, backgroundIntensity);
    EXPECT_SAME_OFFSET(frame, FrameConstants, culls);
    EXPECT_SAME_OFFSET(frame, FrameConstants, skyIntensity);
    EXPECT_SAME_OFFSET(frame, FrameConstants, beams);
    EXPECT_SAME_OFFSET(frame, FrameConstants, beamCount);
    const SpirvStruct beam = spirvStruct(shaderCode("beams.comp"), "GpuBeam");
    EXPECT_SAME_OFFSET(beam, GpuBeam, direction);
    EXPECT_SAME_OFFSET(beam, GpuBeam, irradiance);
    EXPECT_SAME_OFFSET(beam, GpuBeam, size);
}

} // namespace
} // namespace penumbra
