#include "app/version_text.h"

#include <vector>
#ifdef MONTELUX_WITH_RENDER
#include "montelux/accel/embree_version.h"
#include "montelux/cluster/communicator.h"
#include "montelux/denoise/oidn_api.h"
#include "montelux/formats/decoders.h"
#include "montelux/image/image_libraries.h"
#include "montelux/mc/math/error.h"
#endif

#include "montelux/mc/math/library_version.h"
#include "montelux/mc/math/processor.h"
#include "montelux/mc/parallel/tbb_version.h"

namespace montelux::app {

namespace {

std::vector<LibraryVersion> libraries() {
    std::vector<LibraryVersion> all;
#ifdef MONTELUX_WITH_RENDER
    all.push_back(embree_version());
    all.push_back(tbb_version());
    for (const LibraryVersion& l : image_libraries()) all.push_back(l);
    for (const LibraryVersion& l : decoders()) all.push_back(l);
    all.push_back({"MPI", mpi_version().empty() ? "" : "(" + mpi_version() + ")"});
#else
    all.push_back(tbb_version());
#endif
    return all;
}

void append(std::string& list, const std::string& item) { list += (list.empty() ? "" : ", ") + item; }

#ifdef MONTELUX_WITH_RENDER
std::string denoiser() {
    try {
        return load_oidn().file;
    } catch (const Error&) { // why, and how to get one, is said by `montelux denoise`
        return "not found ('montelux denoise --help')";
    }
}
#endif

} // namespace

std::string version_text() {
    std::string text = "montelux " MONTELUX_VERSION, with, without;
    if (const std::string level = compiled_processor_level(); !level.empty())
        text += "\nprocessor: " + level + " or newer";
    for (const auto& [name, version] : libraries())
        version.empty() ? append(without, name) : append(with, name + " " + version);
    text += "\nwith: " + with;
    if (!without.empty()) text += "\nwithout: " + without;
#ifdef MONTELUX_WITH_RENDER
    text += "\nOpen Image Denoise: " + denoiser();
#endif
    return text;
}

} // namespace montelux::app
