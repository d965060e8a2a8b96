#include "files/hdf5/texts.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <unordered_map>

#include "files/hdf5/hdf5.hpp"

namespace carom::files::hdf5 {

namespace {

// HDF5 File Format Specification 3.0, IV.B: what a file holds in the place of such a text: its
// length (4 bytes), the address of a collection (8), the index of an object in it (4).
constexpr std::size_t reference_size = 16;
struct Reference {
  std::uint32_t length, index;
  std::uint64_t collection;
};

std::uint64_t little_endian(const char* bytes, std::size_t size) {
  std::uint64_t number = 0;
  for (std::size_t i = size; i-- > 0;) number = number << 8 | static_cast<unsigned char>(bytes[i]);
  return number;
}

Reference reference_in(const char* bytes) {
  return {static_cast<std::uint32_t>(little_endian(bytes, 4)),
          static_cast<std::uint32_t>(little_endian(bytes + 12, 4)), little_endian(bytes + 4, 8)};
}

// HDF5 would follow references when it converts texts to memory. This conversion to arrays of bytes
// leaves them as they are. (It holds for all of the process: h5py has one of its own to opaque
// types.)
herr_t keep_references(hid_t, hid_t, H5T_cdata_t* how, std::size_t, std::size_t, std::size_t, void*,
                       void*, hid_t) {
  how->need_bkg = H5T_BKG_NO;
  return 0;
}

// The type to which texts can be so converted, or an invalid identifier.
hid_t plain_bytes() {
  static const hid_t type = [] {
    const hsize_t size = reference_size;
    const hid_t bytes = H5Tarray_create2(H5T_NATIVE_UCHAR, 1, &size);
    const Handle text(H5Tcopy(H5T_C_S1), H5Tclose);
    const bool ready =
        H5Tset_size(text.get(), H5T_VARIABLE) >= 0 &&
        H5Tregister(H5T_PERS_SOFT, "references", text.get(), bytes, keep_references) >= 0;
    return ready ? bytes : hid_t{-1};
  }();
  return type;
}

// The global heap of a file. Specification, III.E: a collection starts with "GCOL", a version, its
// size (header included); objects follow, each with an index (2 bytes), a count of references (2),
// 4 bytes of no meaning, its size (8), and its bytes, padded to a multiple of 8. Object 0 is the
// free space; its size includes these 16 bytes.
class GlobalHeap {
 public:
  explicit GlobalHeap(int descriptor) : descriptor_(descriptor) {
    struct stat about {};
    if (::fstat(descriptor, &about) == 0) file_size_ = static_cast<std::uint64_t>(about.st_size);
  }

  bool read(const Reference& from, std::string& text) {
    text.clear();
    if (from.length == 0) return true;
    if (from.collection != collection_ && !list(from.collection)) return false;
    const auto object = objects_.find(from.index);
    if (object == objects_.end() || object->second.size != from.length) return false;
    text.resize(from.length);
    return read(object->second.address, text.data(), text.size());
  }

 private:
  static constexpr std::uint64_t header = 16;
  struct Object {
    std::uint64_t address, size;
  };

  // Most collections are small: one reading gets all of their headers.
  static constexpr std::size_t window_size = std::size_t{1} << 16;
  bool read(std::uint64_t address, char* bytes, std::size_t size) {
    if (address < window_start_ || address - window_start_ > window_.size() ||
        size > window_.size() - (address - window_start_))
      return read_file(address, bytes, size);
    std::memcpy(bytes, window_.data() + (address - window_start_), size);
    return true;
  }
  void look_from(std::uint64_t address) {
    window_start_ = address;
    window_.resize(std::min<std::uint64_t>(
        window_size, address < file_size_ ? file_size_ - address : std::uint64_t{0}));
    if (!read_file(address, window_.data(), window_.size())) window_.clear();
  }
  bool read_file(std::uint64_t address, char* bytes, std::size_t size) const {
    return address <= file_size_ && size <= file_size_ - address &&
           ::pread(descriptor_, bytes, size, static_cast<off_t>(address)) ==
               static_cast<ssize_t>(size);
  }

  // Finds the objects of a collection. HDF5 itself follows these sizes when it changes a text, so
  // all of them must be right: steps forward, within the collection, no index twice.
  bool list(std::uint64_t collection) {
    collection_ = 0;  // no collection: the file begins there
    objects_.clear();
    look_from(collection);
    std::array<char, header> bytes;
    if (!read(collection, bytes.data(), header)) return false;
    constexpr std::string_view signature("GCOL\1\0\0\0", 8);
    const std::uint64_t size = little_endian(bytes.data() + 8, 8);
    if (std::string_view(bytes.data(), 8) != signature || size > file_size_ - collection)
      return false;
    std::uint64_t at = header;
    while (size >= at && size - at >= header) {
      if (!read(collection + at, bytes.data(), header)) return false;
      const std::uint64_t index = little_endian(bytes.data(), 2),
                          length = little_endian(bytes.data() + 8, 8), left = size - at;
      if (length > left) return false;
      const std::uint64_t step = index == 0 ? length : header + (length + 7) / 8 * 8;
      const bool fits = step >= header && step <= left;
      if (!fits || !objects_
                        .try_emplace(static_cast<std::uint32_t>(index),
                                     Object{collection + at + header, length})
                        .second)
        return false;
      at += step;
    }
    collection_ = collection;
    return true;
  }

  int descriptor_;
  std::uint64_t file_size_ = 0, collection_ = 0, window_start_ = 0;
  std::string window_;
  std::unordered_map<std::uint32_t, Object> objects_;
};

// Dataset or attribute.
struct Owner {
  hid_t id;
  bool attribute = H5Iget_type(id) == H5I_ATTR;

  hid_t type() const { return attribute ? H5Aget_type(id) : H5Dget_type(id); }
  hid_t space() const { return attribute ? H5Aget_space(id) : H5Dget_space(id); }
  bool read(hid_t as, void* bytes) const {
    return attribute ? H5Aread(id, as, bytes) >= 0
                     : H5Dread(id, as, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes) >= 0;
  }
};

// The descriptor of the file to which `owner` belongs, everything written; -1 where it has none.
int descriptor_of(hid_t owner) {
  const Handle file(H5Iget_file_id(owner), H5Fclose);
  const Handle access(file ? H5Fget_access_plist(file.get()) : -1, H5Pclose);
  unsigned intent = 0;
  void* descriptor = nullptr;
  if (!access || H5Pget_driver(access.get()) != H5FD_SEC2 ||
      H5Fget_intent(file.get(), &intent) < 0 ||
      ((intent & H5F_ACC_RDWR) != 0 && H5Fflush(file.get(), H5F_SCOPE_LOCAL) < 0) ||
      H5Fget_vfd_handle(file.get(), H5P_DEFAULT, &descriptor) < 0)
    return -1;
  return *static_cast<const int*>(descriptor);
}

}  // namespace

std::optional<std::vector<std::string>> texts_of(hid_t id) {
  const Owner owner{id};
  const Handle type(owner.type(), H5Tclose), space(owner.space(), H5Sclose);
  const hssize_t count = space ? H5Sget_simple_extent_npoints(space.get()) : -1;
  if (!type || H5Tget_class(type.get()) != H5T_STRING || count < 0) return {};
  std::vector<std::string> texts(static_cast<std::size_t>(count));
  if (texts.empty()) return texts;
  const bool variable = H5Tis_variable_str(type.get()) > 0;
  const std::size_t size = variable ? reference_size : H5Tget_size(type.get());
  std::string bytes(texts.size() * size, '\0');
  if (!owner.read(variable ? plain_bytes() : type.get(), bytes.data())) return {};
  const int descriptor = variable ? descriptor_of(id) : -1;
  if (variable && descriptor < 0) return {};
  GlobalHeap heap(descriptor);
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const char* at = bytes.data() + i * size;
    if (!variable)
      texts[i].assign(at, ::strnlen(at, size));
    else if (!heap.read(reference_in(at), texts[i]))
      return {};
  }
  return texts;
}

}  // namespace carom::files::hdf5
