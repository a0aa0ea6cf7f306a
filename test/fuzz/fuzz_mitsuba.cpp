// Scenes of Mitsuba 3, with a file (scene_and_file.h). The tables of the sky take seconds.
#include "test/fuzz/scene_and_file.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return montelux::read_or_refuse_scene(data, size, "scene.xml", {"sunsky"});
}
