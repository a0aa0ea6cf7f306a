// What a command asks for, checked before the work: outputs, memory, slices; and what is said about its scene.
#pragma once

#include "app/render/render_options.h"
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "montelux/formats/studio.h"
#include "montelux/formats/warnings.h"
#include "montelux/render/render_target.h"
#include "montelux/scene/render_settings.h"

namespace montelux::app {

// The pictures to write, each once: those of -o, or else the scene's own.
std::vector<std::string> outputs_of(const RenderOptions& options, const SceneDescription& description);

// Throws UsageError for an output from which the scene was read; check_picture_path also for the reasons of
// check_writable.
void check_not_read(const std::string& output, const std::vector<std::filesystem::path>& files_read);
void check_picture_path(const std::string& output, const std::vector<std::filesystem::path>& files_read);

// Throws Error for a film larger than the machine's memory, and UsageError for slices of other layers than the standard
// ones.
void check_requested(const SceneDescription& description, const RenderTarget& target, bool with_checkpoints);

// Prints the warnings about scenes, and the studios that were added to them; of the frames of a sequence, each once.
class LoadNotices {
  public:
    void print(const std::string& scene, const Warnings& warnings, const StudioParts& added);

  private:
    void print_once(const std::string& line);

    std::set<std::string> printed_;
};

} // namespace montelux::app
