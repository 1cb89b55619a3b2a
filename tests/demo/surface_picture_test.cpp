// Colours of surfaces on the traced picture.
#include "demo/surface_picture.h"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

TEST(SurfacePicture, PaintsOnlyInstancesWithASurface)
{
    // A plain instance, one with a surface that shines, a light's surface beyond the instances, the
    // background.
    ReferencePicture picture;
    picture.instance = {0, 1, 2, kNoInstance};
    picture.emission = {vec3(0), vec3(3), vec3(4), vec3(0)};
    picture.radiance.shadowed.assign(4, vec3(5));
    picture.radiance.unshadowed.assign(4, vec3(7));
    SurfacePicture surfaces;
    surfaces.painted = {false, true};
    surfaces.color.assign(4, vec3(0.5f, 0.25f, 0));
    surfaces.emission.assign(4, vec3(1, 2, 3));
    paintSurfaces(surfaces, picture);
    EXPECT_EQ(picture.radiance.shadowed,
              (std::vector<vec3>{vec3(5), vec3(2, 2.5f, 3), vec3(5), vec3(5)}));
    EXPECT_EQ(picture.radiance.unshadowed,
              (std::vector<vec3>{vec3(7), vec3(3, 3, 3), vec3(7), vec3(7)}));
    paintSurfaces({}, picture); // no surface in the scene
    EXPECT_EQ(picture.radiance.shadowed[1], vec3(2, 2.5f, 3));
}

} // namespace
} // namespace penumbra
