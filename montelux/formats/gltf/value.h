// Value: a value of a glTF file's JSON with its place; reads numbers, texts and indices, or says what is wrong.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "montelux/formats/gltf/diagnostics.h"
#include "montelux/mc/math/vec.h"

namespace montelux::gltf {

// Refers to JSON and diagnostics that must outlive it. All readers throw Error "file: /pointer: sentence".
class Value {
  public:
    Value(const nlohmann::json& json, std::string pointer, Diagnostics& diagnostics)
        : json_(&json), pointer_(std::move(pointer)), diagnostics_(&diagnostics) {}

    const std::string& pointer() const { return pointer_; }
    Diagnostics& diagnostics() const { return *diagnostics_; }
    SourceLocation place() const { return diagnostics_->place(pointer_); }
    [[noreturn]] void error(std::string_view sentence) const { diagnostics_->error(pointer_, sentence); }
    void warn(std::string_view sentence) const { diagnostics_->warn(pointer_, sentence); }

    // The value itself.
    double number(double least = -std::numeric_limits<double>::max(),
                  double most = std::numeric_limits<double>::max()) const;
    // An integer from 0 to 2^53.
    std::uint64_t whole() const;
    const std::string& text() const;
    bool boolean() const;

    // Of an array.
    std::size_t size() const;
    Value operator[](std::size_t i) const;
    // Exactly `count` numbers.
    std::vector<double> numbers(std::size_t count) const;

    // Of an object. Empty where there is no such member.
    std::optional<Value> find(std::string_view key) const;
    Value required(std::string_view key) const;
    // All keys, in alphabetical order.
    std::vector<std::string> keys() const;
    double number(std::string_view key, double otherwise, double least = -std::numeric_limits<double>::max(),
                  double most = std::numeric_limits<double>::max()) const;
    std::uint64_t whole(std::string_view key, std::uint64_t otherwise) const;
    std::string text(std::string_view key, std::string_view otherwise) const;
    bool boolean(std::string_view key, bool otherwise) const;
    Vec3f vec3(std::string_view key, Vec3f otherwise) const;
    // A linear colour; its components are not negative.
    Vec3f color(std::string_view key, Vec3f otherwise) const;
    // The elements of an array; none where there is no such member.
    std::vector<Value> elements(std::string_view key) const;
    // The member "extensions" / `name`.
    std::optional<Value> extension(std::string_view name) const;

  private:
    [[noreturn]] void wrong_type(std::string_view expected) const;
    void check_object() const;

    const nlohmann::json* json_;
    std::string pointer_;
    Diagnostics* diagnostics_;
};

// " 0.5": as short as six digits allow.
std::string shown_number(double value);

} // namespace montelux::gltf
