// SPDX-License-Identifier: MIT
// make_scene OUT.glb [NAME]: writes the built-in scene or one of the papers' scenes. Everything is
// computed here; the bytes never change.
#include <cstdio>
#include <exception>
#include <iostream>

#include "make_scene_scenes.h"

namespace tools {

namespace {

int usage() {
    std::cerr << "usage: make_scene OUT.glb [NAME]\nNAME is one of";
    for (const NamedScene& scene : kScenes) std::cerr << " " << scene.name;
    std::cerr << "; without it, " << kScenes[0].name << "\n";
    return 2;
}

void write(const NamedScene& scene, const std::string& path) {
    GltfWriter writer;
    writer.document()["scene"] = 0;
    writer.document()["scenes"] =
        nlohmann::json::array({{{"name", scene.name}, {"nodes", nlohmann::json::array()}}});
    scene.make(writer);
    std::printf("%zu bytes\n", writer.write(path));
}

int run(int argc, char** argv) {
    if (argc < 2 || argc > 3) return usage();
    const std::string_view name = argc == 3 ? argv[2] : kScenes[0].name.data();
    for (const NamedScene& scene : kScenes) {
        if (scene.name != name) continue;
        write(scene, argv[1]);
        return 0;
    }
    std::cerr << "make_scene: no scene is called '" << name << "'\n";
    return usage();
}

}  // namespace

}  // namespace tools

int main(int argc, char** argv) {
    try {
        return tools::run(argc, argv);
    } catch (const std::exception& error) {
        std::cerr << "make_scene: " << error.what() << "\n";
        return 1;
    }
}
