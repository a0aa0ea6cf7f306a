// Scenes of pbrt-v4, with a file (scene_and_file.h). The tables of the light "sky" and of the camera "realistic" take
// seconds.
#include "test/fuzz/scene_and_file.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return montelux::read_or_refuse_scene(data, size, "scene.pbrt", {"sky", "realistic"});
}
