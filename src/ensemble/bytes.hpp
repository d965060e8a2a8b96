// Plain values as bytes, for messages between processes of one program.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "carom/base/error.hpp"

namespace carom {

class BytesOut {
 public:
  template <class T>
  BytesOut& operator<<(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    return append(&value, sizeof value);
  }
  template <class T>
  BytesOut& operator<<(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    *this << std::uint64_t{values.size()};
    return append(values.data(), values.size() * sizeof(T));
  }
  BytesOut& operator<<(const std::string& text) {
    *this << std::uint64_t{text.size()};
    return append(text.data(), text.size());
  }
  std::vector<std::byte> bytes;

 private:
  BytesOut& append(const void* data, std::size_t size) {
    const std::size_t at = bytes.size();
    bytes.resize(at + size);
    if (size > 0) std::memcpy(bytes.data() + at, data, size);
    return *this;
  }
};

class BytesIn {
 public:
  explicit BytesIn(const std::vector<std::byte>& bytes) : bytes_(bytes) {}
  template <class T>
  BytesIn& operator>>(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    return copy(&value, sizeof value);
  }
  template <class T>
  BytesIn& operator>>(std::vector<T>& values) {
    values.resize(size(sizeof(T)));
    return copy(values.data(), values.size() * sizeof(T));
  }
  BytesIn& operator>>(std::string& text) {
    text.resize(size(1));
    return copy(text.data(), text.size());
  }

 private:
  std::size_t size(std::size_t each) {
    std::uint64_t count = 0;
    *this >> count;
    if (count > (bytes_.size() - at_) / each) throw InternalError("a message is too short");
    return count;
  }
  BytesIn& copy(void* to, std::size_t size) {
    if (size > bytes_.size() - at_) throw InternalError("a message is too short");
    if (size > 0) std::memcpy(to, bytes_.data() + at_, size);
    at_ += size;
    return *this;
  }
  const std::vector<std::byte>& bytes_;
  std::size_t at_ = 0;
};

}  // namespace carom
