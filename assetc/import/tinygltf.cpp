// tinygltf's implementation, built from its header: the Debian 12 library lays TinyGLTF out
// differently from the header that it ships with (SetFsCallbacks writes over other members), so
// only the header is used. The definitions in assetc/CMakeLists.txt leave out images, files and
// Draco.
#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
