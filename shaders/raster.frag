#version 460
// raster: interpolated vertex radiance, linear RGB in W/(m² sr).
layout(location = 0) in vec3 radianceIn;
layout(location = 0) out vec4 color;

void main() { color = vec4(radianceIn, 1.0); }
