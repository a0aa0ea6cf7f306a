// BuildMessages: errors and warnings of a scene under construction, with their places.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "montelux/mc/math/error.h"

namespace montelux {

// A place in a scene file. Lines and columns count from 1; columns count bytes. The reader creates it and
// formats it; the builder stores it for errors found later.
struct SourceLocation {
    std::uint32_t file = 0, line = 1, column = 1;
};

// An error with its place in the scene file. Code that reads other files or checks values throws plain
// Errors, which become located ones if the scene file is the cause.
class LocatedError : public Error {
  public:
    using Error::Error;
};

class BuildMessages {
  public:
    virtual ~BuildMessages() = default;
    // A place as text, such as "file:line:column".
    virtual std::string describe(SourceLocation at) const = 0;
    // Throws LocatedError "place: sentence".
    [[noreturn]] void error(SourceLocation at, std::string_view sentence) const {
        throw LocatedError(describe(at), sentence);
    }
    virtual void warn(SourceLocation at, std::string_view sentence) = 0;
    // Keeps only the first warning of each key.
    virtual void warn_once(std::string_view key, SourceLocation at, std::string_view sentence) = 0;
};

// For values from a function call: its name is the place of all messages.
class CallMessages final : public BuildMessages {
  public:
    // `warnings`, if given, receives the warnings.
    explicit CallMessages(std::string call, std::vector<std::string>* warnings = nullptr)
        : call_(std::move(call)), warnings_(warnings) {}

    std::string describe(SourceLocation) const override { return call_; }
    void warn(SourceLocation, std::string_view sentence) override {
        if (warnings_ != nullptr) warnings_->push_back(call_ + ": " + std::string(sentence));
    }
    void warn_once(std::string_view, SourceLocation at, std::string_view sentence) override {
        warn(at, sentence);
    }

  private:
    std::string call_;
    std::vector<std::string>* warnings_;
};

} // namespace montelux
