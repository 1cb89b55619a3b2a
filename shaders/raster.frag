#version 460
// raster: radiance of the receivers, linear RGB in W/(m² sr).
layout(location = 0) in vec3 radianceIn;
layout(location = 0) out vec4 color;

void main()
{
    const vec3 radiance = radianceIn; // of the vertices, interpolated
    color = vec4(radiance, 1.0);
}
