// Chunks that Carom makes are chunks as HDF5's filters leave them, and sums those that HDF5 and
// zlib know.
#include "files/hdf5/chunk_packer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "../scratch_folder.hpp"
#include "files/hdf5/columns.hpp"
#include "files/hdf5/deflate.hpp"
#include "files/hdf5/hdf5.hpp"
#include "files/hdf5/sums.hpp"

namespace carom::files::hdf5 {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Random = std::mt19937_64;

template <class T>
Bytes bytes_of(const std::vector<T>& values) {
  Bytes bytes(values.size() * sizeof(T));
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

// What HDF5 reads from a chunk with these filters.
class Reader {
 public:
  Reader() : path_(folder_.file("a.h5")) {
    prepare();
    file_ =
        checked(H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose, path_);
  }
  template <class T>
  void expect(const std::vector<T>& values, ChunkPacker::Packed packed, const std::string& what) {
    Handle dataset =
        create_growing(file_.get(), "x", native_type<T>(), values.size(), {"1", ""}, path_);
    ASSERT_TRUE(is_packed(dataset.get(), path_));
    extend(dataset.get(), values.size(), path_);
    write_packed_chunk(dataset.get(), 0, packed, path_);
    dataset.close();
    const auto read = read_column<T>(file_.get(), "x", path_);
    ASSERT_EQ(read.size(), values.size()) << what;
    EXPECT_EQ(std::memcmp(read.data(), values.data(), values.size() * sizeof(T)), 0) << what;
    ASSERT_GE(H5Ldelete(file_.get(), "x", H5P_DEFAULT), 0);
  }

 private:
  ScratchFolder folder_;
  std::string path_;
  Handle file_;
};

double unit(Random& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

// Columns as runs have them, and others.
struct Kind {
  const char* name;
  std::function<double(Random&, double before, std::size_t row)> next;
};
const Kind kinds[] = {
    {"noise", [](Random& r, double, std::size_t) { return 2.0 * unit(r) - 1.0; }},
    {"any bits",
     [](Random& r, double, std::size_t) {
       const std::uint64_t word = r();
       double x = 0.0;
       std::memcpy(&x, &word, sizeof x);
       return x;
     }},
    {"times", [](Random& r, double t, std::size_t) { return t + unit(r); }},
    {"late times", [](Random& r, double t, std::size_t) { return std::fmax(t, 1e6) + unit(r); }},
    {"two walls",
     [](Random& r, double, std::size_t) { return r() % 2   ? 0.3
                                                 : r() % 2 ? 1.7
                                                           : unit(r); }},
    {"signs", [](Random& r, double v, std::size_t) { return r() % 3 ? -v : unit(r); }},
    {"last digits",
     [](Random& r, double v, std::size_t) {
       return r() % 4 == 0 ? unit(r) : r() % 2 ? std::nextafter(v, 2.0) : -v;
     }},
    {"one value", [](Random&, double, std::size_t) { return 0.1; }},
    {"few values", [](Random& r, double, std::size_t) { return static_cast<double>(r() % 5); }},
    {"rare values",
     [](Random& r, double, std::size_t) {
       return std::ldexp(1.0, -static_cast<int>(__builtin_ctzll(r() | 1ull << 60)));
     }},
    {"then another", [](Random& r, double, std::size_t row) { return row < 700 ? 0.5 : unit(r); }},
    {"steps that the look misses",
     [](Random& r, double v, std::size_t row) {
       return row % 4 == 1 ? v : row % 4 == 2 ? 1.0 / v : unit(r);
     }},
};

std::vector<DeflateLibrary> libraries() {
  std::vector<DeflateLibrary> all{DeflateLibrary::zlib};
  if (has(DeflateLibrary::isal)) all.push_back(DeflateLibrary::isal);
  return all;
}

class ChunkPackers : public testing::TestWithParam<DeflateLibrary> {};
INSTANTIATE_TEST_SUITE_P(Libraries, ChunkPackers, testing::ValuesIn(libraries()),
                         [](const auto& one) {
                           return one.param == DeflateLibrary::zlib ? "zlib" : "isal";
                         });

TEST_P(ChunkPackers, HDF5ReadsWhatWasPacked) {
  Reader reader;
  ChunkPacker packer(GetParam());
  Random random(1);
  for (const Kind& kind : kinds)
    for (const std::size_t count : {1u, 2u, 15u, 16u, 17u, 300u, 1024u, 4100u, 16384u, 50'000u}) {
      std::vector<double> values;
      double x = 0.25;
      for (std::size_t i = 0; i < count; ++i) values.push_back(x = kind.next(random, x, i));
      const auto packed = packer.pack(bytes_of(values), sizeof(double));
      EXPECT_LE(packed.bytes.size(), 8 * count + count / 20 + 128) << kind.name;
      reader.expect(values, packed, std::string(kind.name) + " " + std::to_string(count));
    }
}

TEST_P(ChunkPackers, PacksIntegersOfAnyWidth) {
  Reader reader;
  ChunkPacker packer(GetParam());
  Random random(2);
  const auto check = [&]<class T>(T) {
    for (const std::size_t count : {5u, 1024u, 16384u})
      for (const unsigned bits : {0u, 1u, 4u, 9u, 60u}) {
        std::vector<T> values;
        T walk = 0;
        for (std::size_t i = 0; i < count; ++i) {
          const std::uint64_t word = random() & ((std::uint64_t{1} << bits) - 1);
          walk = static_cast<T>(walk + static_cast<T>(random() % 3) - 1);
          values.push_back(static_cast<T>(bits == 9 ? walk : static_cast<T>(word)));
        }
        reader.expect(values, packer.pack(bytes_of(values), sizeof(T)),
                      std::to_string(8 * sizeof(T)) + " bits, random " + std::to_string(bits));
      }
  };
  check(std::int64_t{});
  check(std::int32_t{});
  check(std::uint8_t{});
}

// Sizes of a value, as docs/developer/archives.md has them: a sign and an exponent are worth
// packing, and what is like the row before needs no more than a byte.
TEST_P(ChunkPackers, MakesThemShorter) {
  ChunkPacker packer(GetParam());
  Random random(3);
  const auto size = [&](const char* name) {
    for (const Kind& kind : kinds)
      if (std::string(kind.name) == name) {
        std::vector<double> values;
        double x = 0.25;
        for (std::size_t i = 0; i < 16384; ++i) values.push_back(x = kind.next(random, x, i));
        return static_cast<double>(packer.pack(bytes_of(values), sizeof(double)).bytes.size()) /
               16384;
      }
    return 0.0;
  };
  EXPECT_LT(size("noise"), 7.0);
  EXPECT_LT(size("late times"), 5.2);
  EXPECT_LT(size("two walls"), 3.5);
  EXPECT_LT(size("signs"), 3.7);
  EXPECT_LT(size("last digits"), 3.5);
  EXPECT_LT(size("one value"), 0.05);
  EXPECT_LT(size("few values"), 0.8);
}

// Stored and deflated parts in any order, of bytes that suit them and that do not.
TEST_P(ChunkPackers, AnyPartHoldsAnyBytes) {
  Reader reader;
  Deflate deflate(GetParam());
  Random random(4);
  for (int round = 0; round < 400; ++round) {
    // Of 1 to 200 000 bytes in up to four parts: noise, few values, or long runs of one byte.
    Bytes bytes(1 + random() % (round % 10 == 0 ? 200'000 : 3000));
    std::uint64_t byte = 0;
    const std::uint64_t values = std::uint64_t{1} << random() % 9, stays = random() % 300;
    for (std::uint8_t& one : bytes) {
      if (random() % (stays + 1) == 0) byte = random() % values;
      one = static_cast<std::uint8_t>(byte);
    }
    deflate.start();
    std::span<const std::uint8_t> left(bytes);
    for (int part = 0; part < 4; ++part) {
      const std::size_t now = part == 3 ? left.size() : random() % (left.size() + 1);
      random() % 2 ? deflate.deflate(left.first(now)) : deflate.store(left.first(now));
      left = left.subspan(now);
    }
    const auto stream = deflate.finish(bytes);
    EXPECT_LE(stream.size(), bytes.size() + bytes.size() / 20 + 128);
    reader.expect(bytes, {stream, false}, "round " + std::to_string(round));
  }
}

// The definitions.
std::uint32_t plain_crc32(const Bytes& bytes, std::uint32_t sum) {
  sum = ~sum;
  for (const std::uint8_t byte : bytes) {
    sum ^= byte;
    for (int bit = 0; bit < 8; ++bit) sum = sum >> 1 ^ (sum % 2 != 0 ? 0xedb88320u : 0u);
  }
  return ~sum;
}
// Zero only of zeros.
std::uint32_t plain_fletcher32(const Bytes& bytes) {
  std::uint64_t sum = 0, sums = 0;
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    sum += bytes[i] * 256u + (i + 1 < bytes.size() ? bytes[i + 1] : 0u);
    sums += sum;
  }
  const auto reduced = [](std::uint64_t x) { return x == 0 ? 0 : (x - 1) % 65535 + 1; };
  return static_cast<std::uint32_t>(reduced(sums) << 16 | reduced(sum));
}

TEST(Sums, AreThoseOfTheirDefinitions) {
  Random random(5);
  for (std::size_t size :
       {0u, 1u, 2u, 3u, 7u, 8u, 9u, 63u, 64u, 65u, 127u, 128u, 200u, 4095u, 4096u, 4097u, 131'073u})
    for (int fill = 0; fill < 3; ++fill) {
      Bytes bytes(size);
      for (std::uint8_t& one : bytes)
        one = fill == 0 ? 0 : fill == 1 ? 0xff : static_cast<std::uint8_t>(random());
      const auto before = static_cast<std::uint32_t>(random());
      EXPECT_EQ(crc32(bytes.data(), size, before), plain_crc32(bytes, before)) << size;
      EXPECT_EQ(fletcher32(bytes.data(), size), plain_fletcher32(bytes)) << size;
    }
}

}  // namespace
}  // namespace carom::files::hdf5
