#version 120

uniform mat4 to_screen;
uniform mat4 to_world;  // of normals

// Towards the sun in world axes, of unit length: from where Gazebo's shines.
const vec3 SUN = vec3(0.482, -0.096, 0.871);
// A face across the light is this bright; facing it and turned away it is that much more and less.
const float ACROSS = 0.62, SWING = 0.38;

void main()
{
  vec3 normal = normalize(mat3(to_world) * gl_Normal);
  gl_Position = to_screen * gl_Vertex;
  gl_FrontColor = vec4((ACROSS + SWING * dot(normal, SUN)) * gl_Color.rgb, gl_Color.a);
}
