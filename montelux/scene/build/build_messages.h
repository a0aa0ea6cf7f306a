// BuildMessages: how a scene that is being built says what is wrong with it, and where that comes from.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "montelux/mc/math/error.h"

namespace montelux {

// A place in a scene file. Lines and columns count from 1; columns count bytes. Who builds gives it and
// turns it into words; the builder keeps it for what it finds out later.
struct SourceLocation {
    std::uint32_t file = 0, line = 1, column = 1;
};

// An error that says where in the scene file it is. What reads other files or checks values by themselves
// throws plain ones, which become located ones where the scene file is the reason.
class LocatedError : public Error {
  public:
    using Error::Error;
};

class BuildMessages {
  public:
    virtual ~BuildMessages() = default;
    // The words for a place, such as "file:line:column".
    virtual std::string describe(SourceLocation at) const = 0;
    // Throws LocatedError "place: sentence".
    [[noreturn]] void error(SourceLocation at, std::string_view sentence) const {
        throw LocatedError(describe(at), sentence);
    }
    virtual void warn(SourceLocation at, std::string_view sentence) = 0;
    // Only the first of all warnings with the same key.
    virtual void warn_once(std::string_view key, SourceLocation at, std::string_view sentence) = 0;
};

// For values that a call gives: its name stands for all places.
class CallMessages final : public BuildMessages {
  public:
    // `warnings`, where given, gets the warnings.
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
