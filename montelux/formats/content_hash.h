// ContentHash: one 128-bit digest of everything that a scene was read from.
#pragma once

#include <cstddef>

#include "montelux/scene/content_digest.h"

namespace montelux {

// Against mistakes (a file that changed between two runs), not against forgery. Depends on the bytes, on the
// order of the pieces and on where one piece ends and the next begins.
class ContentHash {
  public:
    void add(const void* data, std::size_t size);
    ContentDigest value() const { return digest_; }

  private:
    ContentDigest digest_; // of the pieces so far
};

} // namespace montelux
