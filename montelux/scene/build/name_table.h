// NameTable: objects of one kind that are declared and referenced by name, in any order.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "montelux/scene/build/build_messages.h"
#include "montelux/scene/index.h"

namespace montelux {

// Each name is looked up once per use, and once when all are declared.
class NameTable {
  public:
    // `what` names the kind in messages: "object".
    explicit NameTable(std::string what) : what_(std::move(what)) {}

    // Declares a name for number `index`. An error if it is taken.
    void declare(const std::string& name, Index index, SourceLocation at, const BuildMessages& messages);

    // A reference to a name, declared or not. Equal for equal names.
    Index refer(const std::string& name);

    // The number that a reference resolves to. An error, with the nearest name, if it is not declared; `by`
    // may name the referrer: "this shape's ".
    Index resolve(Index reference, SourceLocation at, const BuildMessages& messages,
                  std::string_view by = {}) const;

  private:
    std::string what_;
    std::map<std::string, Index> declared_;
    std::map<std::string, Index> reference_of_;
    std::vector<std::string> names_; // of references
};

} // namespace montelux
