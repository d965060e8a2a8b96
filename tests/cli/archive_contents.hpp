// What stands in an archive, read without the program's own reader.
#pragma once

#include <gtest/gtest.h>
#include <hdf5.h>

#include <cstring>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace carom {

/// All datasets of a file as bytes, and what is missing of their descriptions.
struct Contents {
  std::map<std::string, std::string> datasets;
  std::vector<std::string> undescribed;
  std::string status;
  int complete = -1;
};

/// The values as bytes; texts of variable length with a zero between them.
inline std::string bytes_of(hid_t type, hid_t space, const std::function<void(void*)>& read) {
  const auto count = static_cast<std::size_t>(H5Sget_simple_extent_npoints(space));
  std::string bytes(count * H5Tget_size(type), '\0');
  if (count > 0) read(bytes.data());
  if (H5Tis_variable_str(type) > 0) {
    std::vector<char*> texts(count);
    if (count > 0) std::memcpy(texts.data(), bytes.data(), count * sizeof(char*));
    bytes.clear();
    for (char* text : texts) {
      bytes.append(text ? text : "").push_back('\0');
      H5free_memory(text);
    }
    if (count > 0) bytes.pop_back();
  }
  H5Sclose(space);
  H5Tclose(type);
  return bytes;
}
inline std::string read_all(hid_t dataset) {
  const hid_t type = H5Dget_type(dataset);
  return bytes_of(type, H5Dget_space(dataset),
                  [&](void* to) { H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, to); });
}
/// Of an attribute; "" where there is none.
inline std::string read_attribute(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return "";
  const hid_t attribute = H5Aopen(object, name, H5P_DEFAULT), type = H5Aget_type(attribute);
  const std::string bytes =
      bytes_of(type, H5Aget_space(attribute), [&](void* to) { H5Aread(attribute, type, to); });
  H5Aclose(attribute);
  return bytes;
}

inline herr_t visit(hid_t file, const char* name, const H5O_info_t* info, void* data) {
  if (info->type != H5O_TYPE_DATASET) return 0;
  auto& contents = *static_cast<Contents*>(data);
  const hid_t dataset = H5Dopen2(file, name, H5P_DEFAULT);
  if (H5Aexists(dataset, "units") <= 0 || H5Aexists(dataset, "description") <= 0)
    contents.undescribed.emplace_back(name);
  contents.datasets[name] = read_all(dataset);
  H5Dclose(dataset);
  return 0;
}

inline Contents open_archive(const std::string& path) {
  Contents contents;
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) return contents;
  H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, visit, &contents, H5O_INFO_BASIC);
  const hid_t complete = H5Aopen(file, "complete", H5P_DEFAULT);
  H5Aread(complete, H5T_NATIVE_INT, &contents.complete);
  H5Aclose(complete);
  contents.status = read_attribute(file, "status").c_str();
  H5Fclose(file);
  return contents;
}

/// Names the first dataset that differs; nothing of /provenance is one.
inline void expect_same_datasets(const std::string& path,
                                 const std::map<std::string, std::string>& expected) {
  const auto found = open_archive(path).datasets;
  EXPECT_EQ(found.size(), expected.size()) << path;
  for (const auto& [name, bytes] : expected) {
    const auto at = found.find(name);
    ASSERT_NE(at, found.end()) << path << ": " << name << " is missing";
    ASSERT_TRUE(at->second == bytes) << path << ": " << name << " differs";
  }
}

}  // namespace carom
