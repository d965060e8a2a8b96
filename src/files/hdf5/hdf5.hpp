// The part of the HDF5 C API that archives need, with owners that close what they opened.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "carom/base/error.hpp"
#include "files/hdf5/chunk_packer.hpp"

namespace carom::files::hdf5 {

/// An HDF5 identifier and how to close it.
class Handle {
 public:
  using Closer = herr_t (*)(hid_t);
  Handle() = default;
  Handle(hid_t id, Closer closer) : id_(id), closer_(closer) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), closer_(other.closer_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(closer_, other.closer_);
    return *this;
  }
  ~Handle() { close(); }
  /// False when closing failed: for a file or dataset that means lost data.
  bool close() { return id_ < 0 || closer_(std::exchange(id_, -1)) >= 0; }
  hid_t get() const { return id_; }
  explicit operator bool() const { return id_ >= 0; }

 private:
  hid_t id_ = -1;
  Closer closer_ = nullptr;
};

/// Must be called before any other use of HDF5: after a failed close its own exit handler crashes.
/// Also ignores SIGXFSZ, so that a limit on file sizes is an error of the write, and calls
/// silence().
void prepare();

/// Stops HDF5 from printing errors of its own in this thread (each thread has its own setting).
void silence();

/// HDF5 met a structure of the file that it cannot read. Only a writer reads some of them, such as
/// lists of free space.
class Damaged : public InputError {
 public:
  using InputError::InputError;
};
/// Throws InputError "cannot write FILE: reason" where `ok` is false; the reason is the system's.
/// Where HDF5 has one of its own, it throws Damaged.
void check(bool ok, const std::string& file);
/// The same for identifiers.
Handle checked(hid_t id, Handle::Closer closer, const std::string& file);

/// Throws InputError: what is to be read is missing or not readable.
[[noreturn]] void cannot_read(const std::string& file, const char* what);

/// What a dataset is: unit "1" for pure numbers.
struct Description {
  const char* units;
  const char* text;
};

/// One value, or `size` values.
Handle create_attribute(hid_t object, const char* name, hid_t type, const hsize_t* size,
                        const std::string& file);
/// Texts are UTF-8 of variable length.
void write_attribute(hid_t object, const char* name, std::string_view value,
                     const std::string& file);
void write_attribute(hid_t object, const char* name, const std::vector<std::string>& values,
                     const std::string& file);
/// A text whose place does not move when it is changed. h5py reads it as bytes.
void write_fixed_attribute(hid_t object, const char* name, std::string_view value,
                           const std::string& file);
/// Overwrites the value of an existing attribute; a text of fixed length is cut or padded to it.
void change_attribute(hid_t object, const char* name, std::string_view value,
                      const std::string& file);
std::string read_string_attribute(hid_t object, const char* name, const std::string& file);
/// Empty if there is no such attribute.
std::vector<std::string> read_string_list_attribute(hid_t object, const char* name,
                                                    const std::string& file);

template <class T>
hid_t native_type() {
  if constexpr (std::is_same_v<T, double>)
    return H5T_NATIVE_DOUBLE;
  else if constexpr (std::is_same_v<T, std::int32_t>)
    return H5T_NATIVE_INT32;
  else if constexpr (std::is_same_v<T, std::int64_t>)
    return H5T_NATIVE_INT64;
  else if constexpr (std::is_same_v<T, std::uint8_t>)
    return H5T_NATIVE_UINT8;
  else if constexpr (std::is_same_v<T, std::uint64_t>)
    return H5T_NATIVE_UINT64;
  else
    static_assert(sizeof(T) == 0, "no such column");
}

/// The number of an attribute.
template <class T>
T read_attribute(hid_t object, const char* name, const std::string& file) {
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  T value{};
  if (!attribute || H5Aread(attribute.get(), native_type<T>(), &value) < 0) cannot_read(file, name);
  return value;
}
template <class T>
requires std::is_arithmetic_v<T>
void write_attribute(hid_t object, const char* name, T value, const std::string& file) {
  const Handle attribute = create_attribute(object, name, native_type<T>(), nullptr, file);
  check(H5Awrite(attribute.get(), native_type<T>(), &value) >= 0, file);
}
template <class T>
requires std::is_arithmetic_v<T>
void change_attribute(hid_t object, const char* name, T value, const std::string& file) {
  const Handle attribute = checked(H5Aopen(object, name, H5P_DEFAULT), H5Aclose, file);
  check(H5Awrite(attribute.get(), native_type<T>(), &value) >= 0, file);
}

/// Is there a link of this name?
inline bool has(hid_t group, const char* name) { return H5Lexists(group, name, H5P_DEFAULT) > 0; }

/// A text as a scalar dataset.
void write_text(hid_t parent, const char* name, std::string_view text, Description,
                const std::string& file);
std::string read_text(hid_t parent, const char* name, const std::string& file);
/// A column of texts.
void write_texts(hid_t parent, const char* name, const std::vector<std::string>& texts, Description,
                 const std::string& file);
std::vector<std::string> read_texts(hid_t parent, const char* name, const std::string& file);

/// A single number as a scalar dataset.
Handle create_scalar(hid_t parent, const char* name, hid_t type, Description,
                     const std::string& file);
template <class T>
void write_number(hid_t parent, const char* name, T value, Description description,
                  const std::string& file) {
  Handle dataset = create_scalar(parent, name, native_type<T>(), description, file);
  check(H5Dwrite(dataset.get(), native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, &value) >= 0,
        file);
  check(dataset.close(), file);
}

/// A dataset of fixed size, with HDF5's own checksums: Fletcher-32 detects damaged rows, except
/// 0x0000 in place of 0xFFFF and the reverse. See checksums.hpp.
Handle create_fixed(hid_t parent, const char* name, hid_t type, std::size_t rows, Description,
                    const std::string& file);
/// A dataset that grows by rows, with the same. Numbers are compressed besides (shuffle, deflate).
/// `usual`: the value of rows that are never written; 0 where it is null.
Handle create_growing(hid_t parent, const char* name, hid_t type, std::size_t chunk, Description,
                      const std::string& file, const void* usual = nullptr);
std::size_t rows_of(hid_t dataset, const std::string& file);
/// Rows that are stored together.
std::size_t chunk_of(hid_t dataset, const std::string& file);
std::string path_of(hid_t dataset, const std::string& file);
/// Are the filters of a dataset shuffle, deflate and Fletcher-32?
bool is_packed(hid_t dataset, const std::string& file);
void extend(hid_t dataset, std::size_t rows, const std::string& file);
void write_rows(hid_t dataset, hid_t type, std::size_t row, std::size_t count, const void* values,
                const std::string& file);
void append_rows(hid_t dataset, hid_t type, std::size_t row, std::size_t count, const void* values,
                 const std::string& file);
/// A whole chunk of a dataset with these filters, from its first row on, past HDF5's cache of
/// chunks.
void write_packed_chunk(hid_t dataset, std::size_t row, ChunkPacker::Packed packed,
                        const std::string& file);

template <class T>
void write_column(hid_t parent, const char* name, std::span<const T> values,
                  Description description, const std::string& file) {
  Handle dataset = create_fixed(parent, name, native_type<T>(), values.size(), description, file);
  check(values.empty() || H5Dwrite(dataset.get(), native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT,
                                   values.data()) >= 0,
        file);
  check(dataset.close(), file);
}
/// Opens a dataset of an archive that is read.
Handle open_column(hid_t parent, const char* name, const std::string& file);
template <class T>
std::vector<T> read_column(hid_t parent, const char* name, const std::string& file) {
  const Handle dataset = open_column(parent, name, file);
  std::vector<T> values(rows_of(dataset.get(), file));
  if (!values.empty() &&
      H5Dread(dataset.get(), native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    cannot_read(file, name);
  return values;
}
/// Reads rows row … row + count - 1.
void read_rows(hid_t dataset, hid_t type, std::size_t row, std::size_t count, void* values,
               const std::string& file);

}  // namespace carom::files::hdf5
