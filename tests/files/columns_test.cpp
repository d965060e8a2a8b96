// Columns of archives: what is read back is what was written, whichever way chunks were stored.
#include "files/hdf5/columns.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "../scratch_folder.hpp"

namespace carom::files::hdf5 {
namespace {

const Description plain{"1", ""};

struct Rows {
  std::vector<double> noise, ends;
  std::vector<std::int32_t> wall;
  std::vector<std::int64_t> cell;
  std::vector<std::uint8_t> one;
};

// Words of zeros and of ones are where sums modulo 65535 have two values; cells stay the usual ones
// over several chunks and then move.
Rows random_rows(std::size_t count, unsigned seed) {
  std::mt19937_64 random(seed);
  Rows rows;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t word = random();
    rows.noise.push_back(static_cast<double>(word) * 0x1p-64 - 0.5);
    const std::uint64_t extreme = i / 1024 % 3 == 0 ? 0 : ~std::uint64_t{0} << (i / 1024 % 3 * 16);
    double end = 0.0;
    std::memcpy(&end, &extreme, sizeof end);
    rows.ends.push_back(end);
    rows.wall.push_back(static_cast<std::int32_t>(word % 4));
    rows.cell.push_back(i < 3 * count / 4 ? -1 : static_cast<std::int64_t>(word % 1000) - 500);
    rows.one.push_back(1);
  }
  return rows;
}

class ColumnsOfAFile {
 public:
  explicit ColumnsOfAFile(const std::string& path) : path_(path) {
    prepare();
    file_ =
        checked(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose, path);
    checked(H5Gcreate2(file_.get(), "/provenance", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose,
            path);
  }
  /// Rows from `first` on; the sums of the columns, if they are known.
  KnownSums write(const Rows& rows, std::size_t first, std::size_t last, double expected) {
    Columns columns(path_, expected);
    if (first == 0) {
      columns.add<double>(file_.get(), "noise", plain);
      columns.add<double>(file_.get(), "ends", plain);
      columns.add<std::int32_t>(file_.get(), "wall", plain);
      columns.add<std::int64_t>(file_.get(), "cell", plain, -1);
      columns.add<std::uint8_t>(file_.get(), "one", plain, 1);
    } else {
      columns.open<double>(file_.get(), "noise");
      columns.open<double>(file_.get(), "ends");
      columns.open<std::int32_t>(file_.get(), "wall");
      columns.open<std::int64_t>(file_.get(), "cell", -1);
      columns.open<std::uint8_t>(file_.get(), "one", 1);
    }
    for (std::size_t i = first; i < last; ++i)
      columns.row(rows.noise[i], rows.ends[i], rows.wall[i], rows.cell[i], rows.one[i]);
    KnownSums sums;
    columns.close(&sums);
    return sums;
  }
  void expect(const Rows& rows) const {
    const auto same = [&]<class T>(const char* name, const std::vector<T>& values) {
      const auto read = read_column<T>(file_.get(), name, path_);
      ASSERT_EQ(read.size(), values.size()) << name;
      EXPECT_TRUE(values.empty() ||
                  std::memcmp(read.data(), values.data(), values.size() * sizeof(T)) == 0)
          << name;
    };
    same("noise", rows.noise);
    same("ends", rows.ends);
    same("wall", rows.wall);
    same("cell", rows.cell);
    same("one", rows.one);
  }
  hid_t id() const { return file_.get(); }
  std::size_t stored(const char* name) const {
    return H5Dget_storage_size(open_column(file_.get(), name, path_).get());
  }

 private:
  std::string path_;
  Handle file_;
};

// HDF5 reads no chunk whose Fletcher-32 is another one than its own.
TEST(Columns, AreReadAsTheyWereWritten) {
  const ScratchFolder folder;
  for (const double expected : {0.0, 1e6})
    for (const std::size_t count : {0u, 1u, 1024u, 5000u, 40'000u, 65'536u}) {
      const Rows rows = random_rows(count, 1);
      ColumnsOfAFile file(folder.file("a.h5"));
      file.write(rows, 0, count, expected);
      file.expect(rows);
      EXPECT_EQ(file.stored("one"), 0u);
    }
}

TEST(Columns, GoOnWhereTheyEnded) {
  const ScratchFolder folder;
  for (const double expected : {0.0, 1e6}) {
    const Rows rows = random_rows(70'000, 2);
    ColumnsOfAFile file(folder.file("a.h5"));
    std::size_t first = 0;
    for (const std::size_t last : {700u, 701u, 20'000u, 49'152u, 70'000u}) {
      file.write(rows, first, last, expected);
      first = last;
    }
    file.expect(rows);
  }
}

// The sums that are taken while columns are written are those of their bytes, which others read.
TEST(Columns, KnowTheirChecksums) {
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  const Rows rows = random_rows(40'000, 3);
  ColumnsOfAFile file(path);
  const KnownSums sums = file.write(rows, 0, 40'000, 1e6);
  EXPECT_EQ(sums.size(), 5u);
  EXPECT_EQ(sums.at("/wall").sum, crc32(rows.wall.data(), rows.wall.size() * 4));
  write_checksums(file.id(), path, sums);
  verify(file.id(), path);
}

}  // namespace
}  // namespace carom::files::hdf5
