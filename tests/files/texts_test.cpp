// Texts in archives: written with variable length, read from files that may be damaged.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "../scratch_folder.hpp"
#include "carom/base/error.hpp"
#include "files/hdf5/checksums.hpp"
#include "files/hdf5/hdf5.hpp"

namespace carom::files::hdf5 {
namespace {

const std::string umlauts = "Stöße im Billard, θ = π/4", empty, large(100'000, 'x');
const std::vector<std::string> names{"bottom", "", "right", "größer"};

// A file in the format of archives.
Handle created(const std::string& path) {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(access.get(), H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
  return checked(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose, path);
}
Handle opened(const std::string& path, unsigned flags = H5F_ACC_RDONLY) {
  return {H5Fopen(path.c_str(), flags, H5P_DEFAULT), H5Fclose};
}

void write_texts(hid_t file, const std::string& path) {
  write_attribute(file, "umlauts", std::string_view(umlauts), path);
  write_attribute(file, "empty", std::string_view(empty), path);
  write_attribute(file, "names", names, path);
  write_attribute(file, "none", std::vector<std::string>(), path);
  write_attribute(file, "number", std::int64_t{7}, path);
  write_text(file, "large", large, {"text", "A text larger than a collection of the heap"}, path);
}

void expect_texts(hid_t file, const std::string& path) {
  EXPECT_EQ(read_string_attribute(file, "umlauts", path), umlauts);
  EXPECT_EQ(read_string_attribute(file, "empty", path), empty);
  EXPECT_EQ(read_string_list_attribute(file, "names", path), names);
  EXPECT_TRUE(read_string_list_attribute(file, "none", path).empty());
  EXPECT_EQ(read_text(file, "large", path), large);
  EXPECT_THROW(read_string_attribute(file, "number", path), InputError);
  EXPECT_THROW(read_string_attribute(file, "names", path), InputError);
}

TEST(Texts, AreReadAsTheyWereWritten) {
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  prepare();
  const Handle file = created(path);
  write_texts(file.get(), path);
  expect_texts(file.get(), path);  // what is not on the disk yet, too
  change_attribute(file.get(), "umlauts", std::string_view("shorter"), path);
  EXPECT_EQ(read_string_attribute(file.get(), "umlauts", path), "shorter");
  change_attribute(file.get(), "umlauts", std::string_view(umlauts), path);
}

TEST(Texts, AreReadWhenTheFileIsOpenedAgain) {
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  prepare();
  {
    const Handle file = created(path);
    write_texts(file.get(), path);
  }
  for (const unsigned flags : {H5F_ACC_RDONLY, H5F_ACC_RDWR})
    expect_texts(opened(path, flags).get(), path);
}

// Earlier builds wrote texts of fixed length.
TEST(Texts, OfFixedLengthAreReadAndChanged) {
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  prepare();
  const Handle file = created(path);
  write_fixed_attribute(file.get(), "status", "completed", path);
  write_fixed_attribute(file.get(), "empty", "", path);
  EXPECT_EQ(read_string_attribute(file.get(), "status", path), "completed");
  EXPECT_EQ(read_string_attribute(file.get(), "empty", path), "");
  change_attribute(file.get(), "status", std::string_view("running"), path);
  EXPECT_EQ(read_string_attribute(file.get(), "status", path), "running");
}

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

// HDF5 would follow the damaged sizes of its heap out of memory: it has no checksum.
TEST(Texts, OfADamagedHeapAreRefusedByTheirChecksums) {
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  prepare();
  {
    const Handle file = created(path);
    const Handle group(H5Gcreate2(file.get(), "provenance", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                       H5Gclose);
    write_attribute(file.get(), "names", names, path);
    write_attribute(file.get(), "umlauts", std::string_view(umlauts), path);
    write_checksums(file.get(), path);
  }
  const std::string bytes = bytes_of(path);
  const std::size_t heap = bytes.find("GCOL");
  ASSERT_NE(heap, std::string::npos);
  int refused = 0, read = 0;
  for (std::size_t at = heap; at < heap + 200; ++at)
    for (const int change : {0x01, 0x10, 0x80, 0xff}) {
      std::string damaged = bytes;
      damaged[at] = static_cast<char>(damaged[at] ^ change);
      std::ofstream(path, std::ios::binary) << damaged;
      const Handle file = opened(path);
      ASSERT_TRUE(file);
      try {
        verify(file.get(), path);
        EXPECT_EQ(read_string_list_attribute(file.get(), "names", path), names) << at;
        EXPECT_EQ(read_string_attribute(file.get(), "umlauts", path), umlauts) << at;
        ++read;
      } catch (const InputError&) {
        ++refused;
      }
    }
  EXPECT_GT(refused, 300) << read;  // signature, sizes, indices and the texts themselves
  EXPECT_GT(read, 50) << refused;   // counts of references, padding
}

}  // namespace
}  // namespace carom::files::hdf5
