#include "montelux/image/sample_array.h"

#include <cstdint>

#include "montelux/image/texel_file.h"

namespace montelux {

template <typename T>
void SampleArray<T>::resize(std::size_t size) {
    if (block_) load();
    own_.resize(size);
    locate();
}

template <typename T>
void SampleArray<T>::move_to(TexelFile& file) {
    if (empty() || block_) return;
    auto block = file.allocate(size_ * sizeof(T));
    block->write(0, std::as_bytes(span()));
    block_ = std::move(block);
    own_ = std::vector<T>();
    locate();
}

template <typename T>
void SampleArray<T>::load() {
    own_.assign(data_, data_ + size_);
    block_.reset();
    locate();
}

template <typename T>
void SampleArray<T>::locate() {
    const std::span<const std::byte> in_file = block_ ? block_->bytes() : std::span<const std::byte>();
    data_ = block_ ? reinterpret_cast<const T*>(in_file.data()) : own_.data();
    size_ = block_ ? in_file.size() / sizeof(T) : own_.size();
}

template class SampleArray<float>;
template class SampleArray<std::uint16_t>;
template class SampleArray<std::uint8_t>;

} // namespace montelux
