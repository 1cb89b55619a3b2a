// penumbra-content SHAPE -o FILE.obj [--list]: writes a shape of the demo as OBJ, for assetc.
// penumbra-content SHAPE -o FILE.glb: likewise a shape with colours, as glTF.
// penumbra-content picture -o FILE.png: writes the picture of its flat light.
// Exit codes: 0 done, 1 the file cannot be written, 2 wrong usage.
#include "demo/content/painted.h"
#include "demo/content/picture.h"
#include "demo/content/shapes.h"

#include <CLI/CLI.hpp>
#include <cstdio>

int main(int argc, char** argv)
{
    using namespace penumbra;
    CLI::App app("Writes a shape of the demo, made by formula, as OBJ (metres, +Y up).",
                 "penumbra-content");
    std::string name, output;
    bool list = false;
    app.add_option("SHAPE", name, "name of a shape, see --list");
    app.add_option("-o,--output", output, "the file to write");
    app.add_flag("--list", list, "list the shapes with their sizes and stop");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }

    if (list) {
        for (const ContentShape& shape : contentShapes()) {
            const ContentMesh mesh = shape.make();
            fmt::print("{:<13} {:>6} vertices {:>6} triangles  {}\n", shape.name,
                       mesh.positions.size(), mesh.indices.size() / 3, shape.description);
        }
        for (const PaintedShape& shape : paintedShapes())
            fmt::print("{:<13} {}\n", shape.name, shape.description);
        fmt::print("picture       the picture of the demo's flat light, as PNG\n");
        return 0;
    }
    const ContentShape* shape = findShape(name);
    const PaintedShape* painted = findPainted(name);
    const bool picture = name == "picture";
    const bool known = shape != nullptr || painted != nullptr || picture;
    if (!known || output.empty()) {
        fmt::print(stderr, "penumbra-content: {}\n",
                   name.empty() ? "no SHAPE given; --list shows the shapes"
                   : !known     ? "no shape is called " + name + "; --list shows the shapes"
                                : "no file given; add -o FILE");
        return 2;
    }
    const Result<void> written = picture   ? writePng(output, makePicture())
                                 : painted ? writePainted(output, painted->make())
                                           : writeObj(output, shape->make());
    if (!written) {
        fmt::print(stderr, "penumbra-content: {}\n", written.error().message);
        return 1;
    }
    return 0;
}
