#include "montelux/formats/pbrt/measured_brdfs.h"

#include "montelux/formats/measured_brdf_file.h"
#include "montelux/mc/math/error.h"

namespace montelux::pbrt {

Index MeasuredBrdfLibrary::index(const std::string& file, Location at) {
    const std::filesystem::path path = files_.find(file, at);
    const auto found = known_.find(path);
    if (found != known_.end()) return found->second;
    std::vector<MeasuredBrdf>& brdfs = builder_.scene().measured_brdfs;
    const std::vector<std::uint8_t> bytes = files_.read(path, at);
    try {
        brdfs.push_back(read_measured_brdf(bytes, path.string()));
    } catch (const Error& e) {
        diagnostics_.error(at, e.what());
    }
    return known_[path] = static_cast<Index>(brdfs.size() - 1);
}

} // namespace montelux::pbrt
