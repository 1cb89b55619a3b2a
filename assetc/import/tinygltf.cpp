// tinygltf's implementation, built from its header into a namespace of our own: Debian 12's
// libdraco exports an older tinygltf with another layout, and whichever library the linker meets
// first would win. The definitions in assetc/CMakeLists.txt rename the namespace and leave out
// images, files and Draco.
#define TINYGLTF_IMPLEMENTATION
#include <fstream> // which the header forgets under TINYGLTF_NO_FS
#include <tiny_gltf.h>
