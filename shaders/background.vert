#version 460
// background: one triangle over the whole target at the far plane (depth 1).
layout(location = 0) out vec2 clip;

void main()
{
    clip = vec2((gl_VertexIndex & 1) * 4 - 1, (gl_VertexIndex & 2) * 2 - 1);
    gl_Position = vec4(clip, 1.0, 1.0);
}
