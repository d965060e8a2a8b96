#include "files/hdf5/hdf5.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <iterator>

#include "files/hdf5/sums.hpp"
#include "files/hdf5/texts.hpp"

namespace carom::files::hdf5 {

namespace {

struct Reasons {
  std::string system;  ///< of the operating system, deep in HDF5's error stack
  std::string own;     ///< the deepest one
  bool no_memory = false;
};

herr_t find_reasons(unsigned depth, const H5E_error2_t* entry, void* data) {
  Reasons& reasons = *static_cast<Reasons*>(data);
  const std::string_view text = entry->desc ? entry->desc : "";
  if (depth == 0) reasons.own = text;
  reasons.no_memory = reasons.no_memory || entry->maj_num == H5E_RESOURCE;
  const std::string_view mark = "error message = '";
  const std::size_t start = text.find(mark);
  if (start != std::string_view::npos) {
    const std::size_t end = text.find('\'', start + mark.size());
    reasons.system = text.substr(start + mark.size(), end - start - mark.size());
  }
  return 0;
}

// UTF-8; H5T_VARIABLE is a size, too.
Handle text_type(std::size_t size, const std::string& file) {
  Handle type = checked(H5Tcopy(H5T_C_S1), H5Tclose, file);
  const H5T_str_t end = size == H5T_VARIABLE ? H5T_STR_NULLTERM : H5T_STR_NULLPAD;
  check(H5Tset_size(type.get(), std::max<std::size_t>(size, 1)) >= 0 &&
            H5Tset_cset(type.get(), H5T_CSET_UTF8) >= 0 && H5Tset_strpad(type.get(), end) >= 0,
        file);
  return type;
}

Handle create_dataset(hid_t parent, const char* name, hid_t type, const Handle& space, hid_t layout,
                      Description description, const std::string& file) {
  Handle dataset =
      checked(H5Dcreate2(parent, name, type, space.get(), H5P_DEFAULT, layout, H5P_DEFAULT),
              H5Dclose, file);
  write_attribute(dataset.get(), "units", description.units, file);
  write_attribute(dataset.get(), "description", description.text, file);
  return dataset;
}

}  // namespace

void cannot_read(const std::string& file, const char* what) {
  throw InputError(Place{file, 0, 0, ""}, fmt::format("'{}' is missing or not readable", what),
                   "an archive that carom wrote");
}

Handle create_attribute(hid_t object, const char* name, hid_t type, const hsize_t* size,
                        const std::string& file) {
  const Handle space =
      checked(size ? H5Screate_simple(1, size, nullptr) : H5Screate(H5S_SCALAR), H5Sclose, file);
  return checked(H5Acreate2(object, name, type, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                 file);
}

void prepare() {
  H5dont_atexit();
  silence();
  std::signal(SIGXFSZ, SIG_IGN);
}

void silence() {
  thread_local bool silent = false;
  if (!silent) H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  silent = true;
}

void check(bool ok, const std::string& file) {
  if (ok) return;
  Reasons reasons;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, find_reasons, &reasons);
  H5Eclear2(H5E_DEFAULT);
  std::string reason = reasons.system;
  if (reason.empty() && reasons.no_memory) reason = "out of memory";
  if (reason.empty() && !reasons.own.empty())
    throw Damaged(Place{file, 0, 0, ""},
                  "a structure of the file is damaged (HDF5: " + reasons.own + ")",
                  "an archive as carom wrote it");
  if (reason.empty()) reason = errno != 0 ? std::strerror(errno) : "the disk may be full";
  throw InputError(fmt::format("cannot write '{}': {}", file, reason));
}

Handle checked(hid_t id, Handle::Closer closer, const std::string& file) {
  check(id >= 0, file);
  return Handle(id, closer);
}

void write_attribute(hid_t object, const char* name, std::string_view value,
                     const std::string& file) {
  const Handle type = text_type(H5T_VARIABLE, file);
  const Handle attribute = create_attribute(object, name, type.get(), nullptr, file);
  const std::string text(value);
  const char* start = text.c_str();
  check(H5Awrite(attribute.get(), type.get(), &start) >= 0, file);
}

void write_attribute(hid_t object, const char* name, const std::vector<std::string>& values,
                     const std::string& file) {
  const Handle type = text_type(H5T_VARIABLE, file);
  const hsize_t size = values.size();
  const Handle attribute = create_attribute(object, name, type.get(), &size, file);
  std::vector<const char*> starts;
  for (const std::string& value : values) starts.push_back(value.c_str());
  check(values.empty() || H5Awrite(attribute.get(), type.get(), starts.data()) >= 0, file);
}

void write_fixed_attribute(hid_t object, const char* name, std::string_view value,
                           const std::string& file) {
  const Handle type = text_type(value.size(), file);
  const Handle attribute = create_attribute(object, name, type.get(), nullptr, file);
  const std::string padded(value.empty() ? std::string(1, '\0') : std::string(value));
  check(H5Awrite(attribute.get(), type.get(), padded.data()) >= 0, file);
}

void change_attribute(hid_t object, const char* name, std::string_view value,
                      const std::string& file) {
  const Handle attribute = checked(H5Aopen(object, name, H5P_DEFAULT), H5Aclose, file);
  const Handle type = checked(H5Aget_type(attribute.get()), H5Tclose, file);
  std::string text(value);
  if (H5Tis_variable_str(type.get()) > 0) {
    const char* start = text.c_str();
    return check(H5Awrite(attribute.get(), type.get(), &start) >= 0, file);
  }
  text.resize(H5Tget_size(type.get()), '\0');
  check(H5Awrite(attribute.get(), type.get(), text.data()) >= 0, file);
}

std::vector<std::string> read_string_list_attribute(hid_t object, const char* name,
                                                    const std::string& file) {
  if (H5Aexists(object, name) <= 0) return {};
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const auto texts = attribute ? texts_of(attribute.get()) : std::nullopt;
  if (!texts) cannot_read(file, name);
  return *texts;
}

std::string read_string_attribute(hid_t object, const char* name, const std::string& file) {
  const std::vector<std::string> texts = read_string_list_attribute(object, name, file);
  if (texts.size() != 1) cannot_read(file, name);
  return texts.front();
}

void write_text(hid_t parent, const char* name, std::string_view value, Description description,
                const std::string& file) {
  const Handle type = text_type(H5T_VARIABLE, file);
  Handle dataset = create_scalar(parent, name, type.get(), description, file);
  const std::string text(value);
  const char* start = text.c_str();
  check(H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, &start) >= 0, file);
  check(dataset.close(), file);
}

void write_texts(hid_t parent, const char* name, const std::vector<std::string>& texts,
                 Description description, const std::string& file) {
  const Handle type = text_type(H5T_VARIABLE, file);
  const hsize_t size = texts.size();
  const Handle space = checked(H5Screate_simple(1, &size, nullptr), H5Sclose, file);
  Handle dataset = create_dataset(parent, name, type.get(), space, H5P_DEFAULT, description, file);
  std::vector<const char*> starts;
  for (const std::string& text : texts) starts.push_back(text.c_str());
  check(texts.empty() ||
            H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, starts.data()) >= 0,
        file);
  check(dataset.close(), file);
}

std::vector<std::string> read_texts(hid_t parent, const char* name, const std::string& file) {
  const Handle dataset(H5Dopen2(parent, name, H5P_DEFAULT), H5Dclose);
  const auto texts = dataset ? texts_of(dataset.get()) : std::nullopt;
  if (!texts) cannot_read(file, name);
  return *texts;
}

std::string read_text(hid_t parent, const char* name, const std::string& file) {
  const std::vector<std::string> texts = read_texts(parent, name, file);
  if (texts.size() != 1) cannot_read(file, name);
  return texts.front();
}

Handle create_scalar(hid_t parent, const char* name, hid_t type, Description description,
                     const std::string& file) {
  const Handle space = checked(H5Screate(H5S_SCALAR), H5Sclose, file);
  const Handle layout = checked(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, file);
  check(H5Pset_alloc_time(layout.get(), H5D_ALLOC_TIME_EARLY) >= 0, file);
  return create_dataset(parent, name, type, space, layout.get(), description, file);
}

Handle create_fixed(hid_t parent, const char* name, hid_t type, std::size_t rows,
                    Description description, const std::string& file) {
  const hsize_t size = rows;
  const Handle space = checked(H5Screate_simple(1, &size, nullptr), H5Sclose, file);
  const Handle layout = checked(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, file);
  check(H5Pset_alloc_time(layout.get(), H5D_ALLOC_TIME_EARLY) >= 0, file);
  if (rows > 0) {
    const hsize_t chunk = std::min<hsize_t>(size, 65536);  // filters work on chunks
    check(H5Pset_chunk(layout.get(), 1, &chunk) >= 0 && H5Pset_fletcher32(layout.get()) >= 0, file);
  }
  return create_dataset(parent, name, type, space, layout.get(), description, file);
}

Handle create_growing(hid_t parent, const char* name, hid_t type, std::size_t chunk,
                      Description description, const std::string& file, const void* usual) {
  const hsize_t none = 0, unlimited = H5S_UNLIMITED, rows = chunk;
  const Handle space = checked(H5Screate_simple(1, &none, &unlimited), H5Sclose, file);
  const Handle layout = checked(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, file);
  check(H5Pset_chunk(layout.get(), 1, &rows) >= 0, file);
  const bool number = H5Tget_class(type) == H5T_INTEGER || H5Tget_class(type) == H5T_FLOAT;
  if (number && H5Zfilter_avail(H5Z_FILTER_DEFLATE) > 0)
    check(H5Pset_shuffle(layout.get()) >= 0 && H5Pset_deflate(layout.get(), 1) >= 0, file);
  check(H5Pset_fletcher32(layout.get()) >= 0, file);  // the last: it guards the others' input
  if (usual) check(H5Pset_fill_value(layout.get(), type, usual) >= 0, file);
  return create_dataset(parent, name, type, space, layout.get(), description, file);
}

std::size_t rows_of(hid_t dataset, const std::string& file) {
  const Handle space = checked(H5Dget_space(dataset), H5Sclose, file);
  const hssize_t points = H5Sget_simple_extent_npoints(space.get());
  check(points >= 0, file);
  return static_cast<std::size_t>(points);
}

std::size_t chunk_of(hid_t dataset, const std::string& file) {
  const Handle layout = checked(H5Dget_create_plist(dataset), H5Pclose, file);
  hsize_t rows = 0;
  check(H5Pget_chunk(layout.get(), 1, &rows) == 1 && rows > 0, file);
  return rows;
}

std::string path_of(hid_t dataset, const std::string& file) {
  const ssize_t length = H5Iget_name(dataset, nullptr, 0);
  check(length > 0, file);
  std::string path(static_cast<std::size_t>(length), '\0');
  check(H5Iget_name(dataset, path.data(), path.size() + 1) == length, file);
  return path;
}

bool is_packed(hid_t dataset, const std::string& file) {
  const Handle layout = checked(H5Dget_create_plist(dataset), H5Pclose, file);
  constexpr H5Z_filter_t filters[] = {H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE,
                                      H5Z_FILTER_FLETCHER32};
  if (H5Pget_nfilters(layout.get()) != static_cast<int>(std::size(filters))) return false;
  for (unsigned i = 0; i < std::size(filters); ++i) {
    unsigned flags = 0;
    std::size_t none = 0;
    if (H5Pget_filter2(layout.get(), i, &flags, &none, nullptr, 0, nullptr, nullptr) != filters[i])
      return false;
  }
  return true;
}

void extend(hid_t dataset, std::size_t rows, const std::string& file) {
  const hsize_t end = rows;
  check(H5Dset_extent(dataset, &end) >= 0, file);
}

void write_rows(hid_t dataset, hid_t type, std::size_t row, std::size_t count, const void* values,
                const std::string& file) {
  const hsize_t start = row, size = count;
  const Handle all = checked(H5Dget_space(dataset), H5Sclose, file);
  check(H5Sselect_hyperslab(all.get(), H5S_SELECT_SET, &start, nullptr, &size, nullptr) >= 0, file);
  const Handle memory = checked(H5Screate_simple(1, &size, nullptr), H5Sclose, file);
  check(H5Dwrite(dataset, type, memory.get(), all.get(), H5P_DEFAULT, values) >= 0, file);
}

void append_rows(hid_t dataset, hid_t type, std::size_t row, std::size_t count, const void* values,
                 const std::string& file) {
  extend(dataset, row + count, file);
  write_rows(dataset, type, row, count, values, file);
}

void write_packed_chunk(hid_t dataset, std::size_t row, ChunkPacker::Packed packed,
                        const std::string& file) {
  std::vector<std::uint8_t> chunk(packed.bytes.begin(), packed.bytes.end());
  const std::uint32_t sum = fletcher32(chunk.data(), chunk.size());
  for (int shift = 0; shift < 32; shift += 8)
    chunk.push_back(static_cast<std::uint8_t>(sum >> shift));
  const hsize_t start = row;
  const std::uint32_t left_out = packed.shuffled ? 0 : 1;  // a bit for each filter: the first one
  check(H5Dwrite_chunk(dataset, H5P_DEFAULT, left_out, &start, chunk.size(), chunk.data()) >= 0,
        file);
}

Handle open_column(hid_t parent, const char* name, const std::string& file) {
  Handle dataset(H5Dopen2(parent, name, H5P_DEFAULT), H5Dclose);
  if (!dataset) cannot_read(file, name);
  return dataset;
}

void read_rows(hid_t dataset, hid_t type, std::size_t row, std::size_t count, void* values,
               const std::string& file) {
  const hsize_t start = row, size = count;
  const Handle all(H5Dget_space(dataset), H5Sclose);
  const Handle memory(H5Screate_simple(1, &size, nullptr), H5Sclose);
  if (!all || !memory ||
      H5Sselect_hyperslab(all.get(), H5S_SELECT_SET, &start, nullptr, &size, nullptr) < 0 ||
      H5Dread(dataset, type, memory.get(), all.get(), H5P_DEFAULT, values) < 0)
    cannot_read(file, "rows");
}

}  // namespace carom::files::hdf5
