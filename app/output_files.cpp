#include "app/output_files.h"

#include "app/joined.h"
#include "app/usage_error.h"
#include <algorithm>
#include <cctype>
#include <exception>
#include <filesystem>
#include <new>

#include "montelux/mc/io/file.h"

namespace montelux::app {
namespace {

namespace fs = std::filesystem;

// Where writing leads, in a form that is the same however the name was written.
fs::path place_of(const std::string& path) {
    std::error_code error;
    const fs::path target = fs::absolute(output_target(path), error);
    fs::path place = fs::weakly_canonical(target, error);
    return error ? target.lexically_normal() : place;
}

} // namespace

void check_output_names(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        if (outputs[i].empty()) continue;
        std::error_code ignored;
        for (const std::string& input : inputs)
            if (!input.empty() && fs::equivalent(input, outputs[i], ignored))
                throw UsageError(outputs[i], "this file is read; what is written needs another name");
        for (std::size_t j = 0; j < i; ++j)
            if (!outputs[j].empty() && place_of(outputs[j]) == place_of(outputs[i]))
                throw UsageError(outputs[i], "two outputs have the same name");
    }
}

void check_extension(const std::string& path, const std::vector<std::string_view>& extensions) {
    std::string extension = fs::path(path).extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (std::find(extensions.begin(), extensions.end(), extension) != extensions.end()) return;
    const std::string name = path.empty() ? "''" : path;
    if (extension.empty())
        throw Error(name,
                    "cannot be written: the name has no extension; expected one of " + joined(extensions));
    throw Error(name,
                "cannot be written: the extension '" + extension + "' is not one of " + joined(extensions));
}

void OutputFiles::write(const std::string& path, const std::function<void()>& write) {
    std::string failure;
    try {
        write();
        written_.push_back(path);
        return;
    } catch (const std::bad_alloc&) {
        failure = path + ": there is not enough memory to write it";
    } catch (const std::exception& e) {
        failure = e.what();
    }
    failures_ += (failures_.empty() ? "" : "; ") + failure;
}

void OutputFiles::throw_failures() const {
    if (!failures_.empty()) throw Error(failures_);
}

} // namespace montelux::app
