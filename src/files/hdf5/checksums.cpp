#include "files/hdf5/checksums.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <sstream>
#include <string_view>
#include <vector>

#include "carom/base/error.hpp"
#include "files/hdf5/hdf5.hpp"
#include "files/hdf5/texts.hpp"

namespace carom::files::hdf5 {

namespace {

constexpr const char* group_name = "provenance";
constexpr const char* list_name = "checksums";
constexpr std::string_view list_path = "/provenance@checksums";
constexpr std::size_t sum_length = 8;  // digits of a sum
constexpr std::size_t batch_bytes = std::size_t{1} << 20;

// What a line says of a dataset or an attribute.
struct Entry {
  std::uint32_t sum = 0;
  std::string type;
  std::uint64_t count = 0;
};

std::string line_of(const Entry& entry, const std::string& path) {
  return fmt::format("{:08x} {} {:015} {}\n", entry.sum, entry.type, entry.count, path);
}

bool is_variable(hid_t type) { return H5Tis_variable_str(type) > 0; }

std::string type_name(hid_t type) {
  const std::size_t size = H5Tget_size(type);
  switch (H5Tget_class(type)) {
    case H5T_INTEGER:
      return fmt::format("{}int{}", H5Tget_sign(type) == H5T_SGN_NONE ? "u" : "", 8 * size);
    case H5T_FLOAT:
      return fmt::format("float{}", 8 * size);
    case H5T_STRING:
      return is_variable(type) ? "text" : fmt::format("text{}", size);
    default:
      return "";
  }
}

// Carom writes numbers and texts, one or a row of them. Others may add anything to an archive.
bool is_plain(hid_t type, hid_t space) {
  const bool text = H5Tget_class(type) == H5T_STRING;
  const bool number = H5Tget_class(type) == H5T_INTEGER || H5Tget_class(type) == H5T_FLOAT;
  return (text || number) && H5Sget_simple_extent_ndims(space) <= 1;
}

// Data that another program added may need a filter that is missing. Those that Carom's archives
// have, as written or after h5repack, are part of HDF5.
bool is_foreign(hid_t dataset) {
  const Handle layout(H5Dget_create_plist(dataset), H5Pclose);
  unsigned flags = 0;
  for (int i = H5Pget_nfilters(layout.get()) - 1; i >= 0; --i) {
    std::size_t none = 0;
    const H5Z_filter_t filter = H5Pget_filter2(layout.get(), static_cast<unsigned>(i), &flags,
                                               &none, nullptr, 0, nullptr, nullptr);
    if (filter != H5Z_FILTER_FLETCHER32 && filter != H5Z_FILTER_SHUFFLE &&
        filter != H5Z_FILTER_DEFLATE)
      return true;
  }
  return false;
}

// Type and number of values; false where HDF5 cannot tell.
bool look(hid_t type, hid_t space, Entry& entry) {
  const hssize_t points = H5Sget_simple_extent_npoints(space);
  if (type < 0 || points < 0 || H5Tget_size(type) == 0) return false;
  entry = {0, is_plain(type, space) ? type_name(type) : "", static_cast<std::uint64_t>(points)};
  return true;
}

// Texts of variable length, each with a byte of zero after it.
bool sum_texts(hid_t owner, Entry& entry) {
  const auto texts = texts_of(owner);
  if (!texts) return false;
  for (const std::string& text : *texts)
    entry.sum = crc32(text.c_str(), text.size() + 1, entry.sum);
  return true;
}

bool sum_dataset(hid_t dataset, hid_t type, Entry& entry) {
  if (is_variable(type)) return sum_texts(dataset, entry);
  const std::size_t size = H5Tget_size(type);
  const std::uint64_t batch = std::max<std::uint64_t>(batch_bytes / size, 1);
  const Handle all(H5Dget_space(dataset), H5Sclose);
  const bool scalar = H5Sget_simple_extent_type(all.get()) == H5S_SCALAR;
  std::vector<char> bytes(std::min(batch, entry.count) * size);
  for (std::uint64_t row = 0; row < entry.count; row += batch) {
    const hsize_t start = row, rows = std::min(batch, entry.count - row);
    const Handle memory(scalar ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &rows, nullptr),
                        H5Sclose);
    if (!scalar &&
        H5Sselect_hyperslab(all.get(), H5S_SELECT_SET, &start, nullptr, &rows, nullptr) < 0)
      return false;
    if (H5Dread(dataset, type, memory.get(), all.get(), H5P_DEFAULT, bytes.data()) < 0)
      return false;
    entry.sum = crc32(bytes.data(), rows * size, entry.sum);
  }
  return true;
}

bool sum_attribute(hid_t attribute, hid_t type, Entry& entry) {
  if (is_variable(type)) return sum_texts(attribute, entry);
  std::vector<char> bytes(entry.count * H5Tget_size(type));
  if (entry.count > 0 && H5Aread(attribute, type, bytes.data()) < 0) return false;
  entry.sum = crc32(bytes.data(), bytes.size());
  return true;
}

// A path as the archive has it, from its own root on: that may be a group of a file.
const char* within(const std::string& path) { return path == "/" ? "." : path.c_str() + 1; }

// "/collisions/t" is a dataset, "/collisions/t@units" one of its attributes. `expected`: what its
// type and number must be before any memory is taken. Its bytes are read where `with_sum` is set;
// an entry without a type is none of Carom's.
bool read_entry(hid_t file, const std::string& path, const Entry* expected, bool with_sum,
                Entry& entry) {
  const auto wanted = [&] {
    const bool as_expected =
        !expected || (entry.type == expected->type && entry.count == expected->count);
    return with_sum && as_expected && !entry.type.empty();
  };
  const std::size_t at = path.find('@');
  if (at == std::string::npos) {
    const Handle dataset(H5Dopen2(file, within(path), H5P_DEFAULT), H5Dclose);
    if (!dataset) return false;
    const Handle type(H5Dget_type(dataset.get()), H5Tclose),
        space(H5Dget_space(dataset.get()), H5Sclose);
    if (!look(type.get(), space.get(), entry)) return false;
    if (is_foreign(dataset.get())) entry.type.clear();
    return !wanted() || sum_dataset(dataset.get(), type.get(), entry);
  }
  const Handle attribute(H5Aopen_by_name(file, within(path.substr(0, at)),
                                         path.substr(at + 1).c_str(), H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  if (!attribute) return false;
  const Handle type(H5Aget_type(attribute.get()), H5Tclose),
      space(H5Aget_space(attribute.get()), H5Sclose);
  if (!look(type.get(), space.get(), entry)) return false;
  return !wanted() || sum_attribute(attribute.get(), type.get(), entry);
}

herr_t add_attribute(hid_t, const char* name, const H5A_info_t*, void* paths) {
  auto& all = *static_cast<std::vector<std::string>*>(paths);
  all.push_back(all.front() + "@" + name);
  return 0;
}

herr_t add_object(hid_t file, const char* name, const H5O_info_t* info, void* paths) {
  const std::string path = std::string_view(name) == "." ? "/" : std::string("/") + name;
  auto& all = *static_cast<std::vector<std::string>*>(paths);
  if (info->type == H5O_TYPE_DATASET) all.push_back(path);
  std::vector<std::string> attributes{path};
  if (H5Aiterate_by_name(file, path.c_str(), H5_INDEX_NAME, H5_ITER_INC, nullptr, add_attribute,
                         &attributes, H5P_DEFAULT) < 0)
    return -1;
  all.insert(all.end(), attributes.begin() + 1, attributes.end());
  return 0;
}

// What a file lists of itself, as other readers see it. In the order of its own index alone: for
// another one HDF5 1.10 makes a table first, and where it cannot read the index, it releases rows
// of that which it has not filled.
class Listing {
 public:
  /// Of everything below the group; false where HDF5 cannot list it.
  bool add(hid_t group, const std::string& path) {
    if (!add_attributes(group, path.empty() ? "/" : path)) return false;
    std::vector<std::string> names;
    if (H5Literate(group, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, add_link, &names) < 0)
      return false;
    for (const std::string& name : names) {
      const Handle object(H5Oopen(group, name.c_str(), H5P_DEFAULT), H5Oclose);
      H5O_info_t info;
      if (!object || H5Oget_info2(object.get(), &info, H5O_INFO_BASIC) < 0) return false;
      const std::string inner = path + "/" + name;
      if (info.type == H5O_TYPE_DATASET) paths.insert(inner);
      const bool again = info.type == H5O_TYPE_GROUP && !groups_.insert(info.addr).second;
      if (again) continue;
      const bool fine = info.type == H5O_TYPE_GROUP ? add(object.get(), inner)
                                                    : add_attributes(object.get(), inner);
      if (!fine) return false;
    }
    return true;
  }
  std::set<std::string> paths;

 private:
  static herr_t add_link(hid_t, const char* name, const H5L_info_t* info, void* names) {
    if (info->type == H5L_TYPE_HARD) static_cast<std::vector<std::string>*>(names)->push_back(name);
    return 0;
  }
  bool add_attributes(hid_t object, const std::string& path) {
    std::vector<std::string> attributes{path};
    if (H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, add_attribute, &attributes) < 0)
      return false;
    paths.insert(attributes.begin() + 1, attributes.end());
    return true;
  }
  std::set<haddr_t> groups_;  // links may lead round
};

// Rows that are stated against bytes that are stored. A chunk of nothing but usual values is not
// stored, but no group of columns has only such: it has times, places or indices. A file that
// states rows without end would take all memory where it is read.
class Sizes {
 public:
  void add(hid_t file, const std::string& path, const Entry& entry) {
    if (path.find('@') != std::string::npos || entry.count <= few_rows) return;
    const Handle dataset(H5Dopen2(file, within(path), H5P_DEFAULT), H5Dclose);
    const Handle type(dataset ? H5Dget_type(dataset.get()) : -1, H5Tclose);
    if (!type) return;
    const std::uint64_t bytes = H5Dget_storage_size(dataset.get());
    Group& group = groups_[path.substr(0, path.rfind('/'))];
    group.path = path;
    const bool holds = entry.count / most_packed <= bytes / H5Tget_size(type.get());
    group.stored = group.stored || holds;
  }
  /// A column of a group of which no column is stored; "": there is none.
  std::string unstored() const {
    for (const auto& [name, group] : groups_)
      if (!group.stored) return group.path;
    return {};
  }

 private:
  static constexpr std::uint64_t few_rows = std::uint64_t{1} << 20;  // these do no harm
  static constexpr std::uint64_t most_packed = 1032;  // deflate packs no bytes closer
  struct Group {
    std::string path;
    bool stored = false;
  };
  std::map<std::string, Group> groups_;
};

std::string list_of(hid_t file, bool with_sums, const std::string& name,
                    const KnownSums& known = {}) {
  std::vector<std::string> paths;
  check(H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, add_object, &paths, H5O_INFO_BASIC) >= 0, name);
  std::string lines;
  for (const std::string& path : paths) {
    if (path == list_path) continue;
    Entry entry;
    const auto sum = known.find(path);
    const bool is_known = sum != known.end();
    check(read_entry(file, path, nullptr, with_sums && !is_known, entry), name);
    if (is_known) {
      if (entry.count != sum->second.count)
        throw InternalError("a column of an archive has another length than was written");
      entry.sum = sum->second.sum;
    }
    if (!entry.type.empty()) lines += line_of(entry, path);
  }
  return fmt::format("{:08x}\n", crc32(lines.data(), lines.size())) + lines;
}

void write_list(hid_t file, const std::string& list, const std::string& name) {
  const Handle group = checked(H5Gopen2(file, group_name, H5P_DEFAULT), H5Gclose, name);
  if (H5Aexists(group.get(), list_name) > 0) {
    const bool fits = read_string_attribute(group.get(), list_name, name).size() == list.size();
    if (fits) return change_attribute(group.get(), list_name, std::string_view(list), name);
    unsigned intent = 0;
    check(H5Fget_intent(file, &intent) >= 0, name);
    if ((intent & H5F_ACC_SWMR_WRITE) != 0)
      throw InternalError("something was added to an archive that others read");
    check(H5Adelete(group.get(), list_name) >= 0, name);
  }
  write_fixed_attribute(group.get(), list_name, std::string_view(list), name);
}

// "1c291ca3 float64 000000000004096 /collisions/t"; false where it is none.
bool parse(const std::string& line, Entry& entry, std::string& path) {
  std::istringstream words(line);
  std::string sum;
  if (!(words >> sum >> entry.type >> entry.count >> path)) return false;
  const char* end = sum.data() + sum.size();
  return sum.size() == sum_length && std::from_chars(sum.data(), end, entry.sum, 16).ptr == end;
}

}  // namespace

void write_checksums(hid_t file, const std::string& name, const KnownSums& known) {
  write_list(file, list_of(file, true, name, known), name);
}

void reserve_checksums(hid_t file, const std::string& name) {
  write_list(file, list_of(file, false, name), name);
}

void verify(hid_t file, const std::string& name) {
  const auto refuse = [&](std::string_view path, const char* what,
                          const char* expected = "an archive as carom wrote it") {
    throw InputError(Place{name, 0, 0, ""}, fmt::format("'{}' {}", path, what), expected);
  };
  constexpr const char* changed = "was changed: its checksum is another";
  constexpr const char* unreadable = "is missing or not readable";
  const Handle group(H5Gopen2(file, group_name, H5P_DEFAULT), H5Gclose);
  if (!group) refuse("/provenance", unreadable);
  if (H5Aexists(group.get(), list_name) <= 0)
    refuse(list_path, unreadable, "an archive that this version of carom wrote");
  const std::string list = read_string_attribute(group.get(), list_name, name);
  const std::size_t start = std::min(list.size(), sum_length + 1);
  if (list.substr(0, start) !=
      fmt::format("{:08x}\n", crc32(list.data() + start, list.size() - start)))
    refuse(list_path, changed);
  std::istringstream lines(list.substr(start));
  std::map<std::string, Entry> entries;
  for (std::string line, path; std::getline(lines, line);) {
    Entry stored;
    if (!parse(line, stored, path)) refuse(list_path, changed);
    entries[path] = stored;
  }
  // All that can be reached: other readers list the groups, and do not ask for names they know.
  Listing listing;
  const Handle root(H5Gopen2(file, ".", H5P_DEFAULT), H5Gclose);
  if (!root || !listing.add(root.get(), "")) refuse("/", "has a damaged index of links");
  Sizes sizes;
  for (const auto& [path, stored] : entries) {
    Entry found;
    if (listing.paths.count(path) == 0 || !read_entry(file, path, &stored, false, found))
      refuse(path, unreadable);
    if (found.type != stored.type || found.count != stored.count) refuse(path, changed);
    sizes.add(file, path, found);
  }
  if (const std::string path = sizes.unstored(); !path.empty())
    refuse(path, "states more rows than the file holds");
  for (const auto& [path, stored] : entries) {
    Entry found;
    if (!read_entry(file, path, &stored, true, found)) refuse(path, unreadable);
    if (found.sum != stored.sum) refuse(path, changed);
  }
}

}  // namespace carom::files::hdf5
