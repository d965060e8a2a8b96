#include "io/archive/deflate.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "base/inline.hpp"

namespace carom::io::hdf5 {

namespace {

constexpr unsigned longest_word = 12;  // of 15 allowed: four of them are put at once
constexpr std::size_t most_plain = 65535, longest_copy = 258, shortest_copy = 3;
constexpr std::size_t head_bits = 3 + 32 + 7;  // of plain bytes

// Lengths 3 to 258 as symbols from 257 on: eight of one length, then four each of 2, 4, 8 … lengths
// (RFC 1951, section 3.2.5). Extra bits say which of them.
struct Length {
  std::uint16_t symbol;
  Bits extra;
};
constexpr Length length_of(std::size_t copied) {
  if (copied == longest_copy) return {285, {}};
  const auto from = static_cast<std::uint32_t>(copied - shortest_copy);
  if (from < 8) return {static_cast<std::uint16_t>(257 + from), {}};
  const auto extra = static_cast<std::uint32_t>(std::bit_width(from)) - 3;
  return {static_cast<std::uint16_t>(257 + 4 * extra + (from >> extra)),
          {from & ((1u << extra) - 1), extra}};
}

// Distances 1 (no extra bits) and 8 (one): the symbol, of which there are two with words of one
// bit, the first of them 0.
constexpr std::size_t distance_symbol(std::size_t distance) { return distance == 1 ? 0 : 5; }
constexpr Bits distance_bits(std::size_t distance) {
  return distance == 1 ? Bits{0, 1} : Bits{2, 2};
}

// Lengths of words follow each other in runs: 16 repeats the last one 3 to 6 times, 17 and 18 stand
// for 3 to 10 and 11 to 138 zeros.
struct Run {
  std::uint8_t symbol;
  Bits extra;
};
std::vector<Run> runs_of(std::span<const std::uint8_t> lengths) {
  std::vector<Run> runs;
  for (std::size_t i = 0; i < lengths.size();) {
    std::size_t same = 1;
    while (i + same < lengths.size() && lengths[i + same] == lengths[i]) ++same;
    std::size_t left = same;
    const auto repeat = [&](std::uint8_t symbol, std::size_t least, std::size_t most,
                            std::uint32_t bits) {
      const std::size_t now = std::min(left, most);
      runs.push_back({symbol, {static_cast<std::uint32_t>(now - least), bits}});
      left -= now;
    };
    if (lengths[i] != 0) runs.push_back({lengths[i], {}}), --left;
    while (left >= 3)
      if (lengths[i] != 0)
        repeat(16, 3, 6, 2);
      else if (left > 10)
        repeat(18, 11, 138, 7);
      else
        repeat(17, 3, 10, 3);
    for (; left > 0; --left) runs.push_back({lengths[i], {}});
    i += same;
  }
  return runs;
}

// Several tables: a count waits for the one before of the same byte.
class ByteCounter {
 public:
  template <std::size_t bytes>
  void add(const std::uint8_t* at) {
    for (std::size_t k = 0; k < bytes; ++k) ++several_[k % 4][at[k]];
  }
  template <class Counts>
  void add_to(Counts& counts) const {
    for (std::size_t byte = 0; byte < 256; ++byte)
      for (const auto& one : several_) counts[byte] += one[byte];
  }

 private:
  std::uint32_t several_[4][256] = {};
};

std::uint64_t value_at(const std::uint8_t* bytes) {
  std::uint64_t value = 0;
  std::memcpy(&value, bytes, sizeof value);
  if constexpr (std::endian::native == std::endian::big) value = __builtin_bswap64(value);
  return value;
}

// Four words, at most 48 bits, at once.
struct Joined {
  std::uint64_t bits = 0;
  std::uint32_t count = 0;
};
CAROM_INLINE Joined joined(Bits a, Bits b, Bits c, Bits d) {
  const std::uint64_t first = a.bits | b.bits << a.count, second = c.bits | d.bits << c.count;
  return {first | second << (a.count + b.count), a.count + b.count + c.count + d.count};
}
CAROM_INLINE Joined four(const Bits* words, const std::uint8_t* at) {
  return joined(words[at[0]], words[at[1]], words[at[2]], words[at[3]]);
}
// Without a branch.
CAROM_INLINE Bits only(bool wanted, Bits word) {
  const std::uint32_t mask = 0u - wanted;
  return {word.bits & mask, word.count & mask};
}
CAROM_INLINE void put(BitWriter& out, Joined words) {
  out.put(words.bits, words.count);
  out.spill();
}

}  // namespace

// A block has a head, and may end within a byte. A block that is given up may have words of twelve
// bits for all of its bytes.
void Deflate::start(std::size_t size, std::size_t parts) {
  constexpr std::size_t head = 6, codes = 512;
  stream_.resize(size + size / 2 + head * (parts + size / most_plain) + codes);
  out_ = BitWriter(stream_.data());
  out_.put(0x0178, 16);  // deflate, distances up to 32768, made fast; as 0x7801 a multiple of 31
}

void Deflate::plain(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const std::size_t now = std::min(bytes.size(), most_plain);
    out_.put(0, 3);
    out_.fill_byte();
    out_.put(now | (now ^ 0xffffu) << 16, 32);
    out_.spill();
    out_.copy(bytes.data(), now);
    bytes = bytes.subspan(now);
  }
}

bool Deflate::begin(Counts& counts, std::size_t distance, std::size_t extra, std::size_t size) {
  counts[end_of_block] = 1;
  std::vector<std::uint8_t> lengths = code_lengths(counts, longest_word);
  std::size_t bits = extra;
  for (std::size_t i = 0; i < symbols; ++i) bits += counts[i] * lengths[i];
  words_ = code_words(lengths);
  while (lengths.back() == 0) lengths.pop_back();
  const std::size_t literals = lengths.size(), first = distance_symbol(distance);
  lengths.resize(literals + first);
  lengths.insert(lengths.end(), 2, 1);
  const std::vector<Run> runs = runs_of(lengths);
  std::array<std::uint32_t, 19> often{};
  for (const Run& run : runs) ++often[run.symbol];
  const std::vector<std::uint8_t> code = code_lengths(often, 7);
  constexpr std::uint8_t order[] = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                    11, 4,  12, 3, 13, 2, 14, 1, 15};
  std::size_t last = std::size(order);
  while (code[order[last - 1]] == 0) --last;
  bits += 3 + 14 + 3 * last;
  for (const Run& run : runs) bits += code[run.symbol] + run.extra.count;
  if (bits >= 8 * size + head_bits) return false;
  out_.put(4, 3);
  out_.put(literals - 257, 5);
  out_.put(first + 1, 5);
  out_.put(last - 4, 4);
  for (std::size_t i = 0; i < last; ++i) out_.put(code[order[i]], 3), out_.spill();
  const std::vector<Bits> words = code_words(code);
  for (const Run& run : runs) out_.put(words[run.symbol]), out_.put(run.extra), out_.spill();
  return true;
}

void Deflate::literals(std::span<const std::uint8_t> bytes) {
  Counts counts{};
  ByteCounter counter;
  std::size_t i = 0;
  for (; i + 4 <= bytes.size(); i += 4) counter.add<4>(&bytes[i]);
  for (; i < bytes.size(); ++i) counter.add<1>(&bytes[i]);
  counter.add_to(counts);
  if (bytes.empty() || !begin(counts, 1, 0, bytes.size())) return plain(bytes);
  const Bits* words = words_.data();
  BitWriter out = out_;
  for (i = 0; i + 4 <= bytes.size(); i += 4) put(out, four(words, &bytes[i]));
  for (; i < bytes.size(); ++i) out.put(words[bytes[i]]), out.spill();
  out.put(words[end_of_block]), out.spill();
  out_ = out;
}

// A run is a literal and copies of it. Shorter ones than six are left to the literals: what they
// would win, looking for them would cost.
void Deflate::runs(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t least = 5;
  constexpr std::uint16_t copy = 256;  // tokens: a literal, or 256 and the length
  Counts counts{};
  std::size_t extra = 0;
  tokens_.clear();
  for (std::size_t i = 0; i < bytes.size();) {
    const std::uint8_t byte = bytes[i];
    const std::uint64_t eight = byte * 0x0101010101010101u;
    std::size_t same = i + 1;
    while (same + 8 <= bytes.size() && value_at(&bytes[same]) == eight) same += 8;
    while (same < bytes.size() && bytes[same] == byte) ++same;
    ++counts[byte];
    tokens_.push_back(byte);
    std::size_t left = same - i - 1;
    while (left >= least) {
      const std::size_t now = std::min(left, longest_copy);
      const Length length = length_of(now);
      ++counts[length.symbol];
      extra += length.extra.count + distance_bits(1).count;
      tokens_.push_back(static_cast<std::uint16_t>(copy + now));
      left -= now;
    }
    counts[byte] += static_cast<std::uint32_t>(left);
    tokens_.insert(tokens_.end(), left, byte);
    i = same;
  }
  if (bytes.empty() || !begin(counts, 1, extra, bytes.size())) return plain(bytes);
  BitWriter out = out_;
  for (const std::uint16_t token : tokens_) {
    if (token < copy) {
      out.put(words_[token]);
    } else {
      const Length length = length_of(token - copy);
      out.put(words_[length.symbol]), out.put(length.extra), out.put(distance_bits(1));
    }
    out.spill();
  }
  out.put(words_[end_of_block]), out.spill();
  out_ = out;
}

// The code is made for some of the rows, with a word for every byte. It may turn out that it does
// not fit the others.
void Deflate::values(std::span<const std::uint8_t> bytes) {
  constexpr std::uint64_t first = 0xffu, last = first << 56, middle = ~(first | last);
  constexpr std::size_t some = 4096;  // rows
  const std::size_t rows = bytes.size() / 8, step = std::max<std::size_t>(1, rows / some);
  if (bytes.size() != 8 * rows || rows < 2) return plain(bytes);
  Counts counts{};
  for (std::size_t byte = 0; byte < 256; ++byte) counts[byte] = 1;
  for (std::size_t same = 0; same < 3; ++same) counts[length_of(8 - same).symbol] = 1;
  ByteCounter counter;
  std::size_t extra = 0;
  for (std::size_t i = 1; i < rows; i += step) {
    const std::uint8_t* at = &bytes[8 * i];
    const std::uint64_t change = value_at(at) ^ value_at(at - 8);
    if ((change & middle) != 0) {
      counter.add<8>(at);
      continue;
    }
    const bool begins = (change & first) != 0, ends = (change & last) != 0;
    counts[at[0]] += begins;
    counts[at[7]] += ends;
    ++counts[length_of(8u - begins - ends).symbol];
    extra += distance_bits(8).count;
  }
  counter.add_to(counts);
  const BitWriter start = out_;
  if (!begin(counts, 8, extra, bytes.size() / step)) return plain(bytes);
  const Bits* words = words_.data();
  const Bits* copies = words + length_of(8).symbol;
  BitWriter out = out_;
  std::uint64_t before = ~value_at(bytes.data());
  for (std::size_t i = 0; i < rows; ++i) {
    const std::uint8_t* at = &bytes[8 * i];
    const std::uint64_t now = value_at(at), change = now ^ before;
    before = now;
    if ((change & middle) != 0) {
      put(out, four(words, at));
      put(out, four(words, at + 4));
      continue;
    }
    const bool begins = (change & first) != 0, ends = (change & last) != 0;
    put(out, joined(only(begins, words[at[0]]), *(copies - begins - ends), distance_bits(8),
                    only(ends, words[at[7]])));
  }
  out.put(words[end_of_block]), out.spill();
  out_ = out;
  if (static_cast<std::size_t>(out.next() - start.next()) <= bytes.size()) return;
  out_ = start;
  plain(bytes);
}

// An empty block of the fixed code is the last one.
std::span<const std::uint8_t> Deflate::finish(std::uint32_t sum) {
  out_.put(3, 10);
  out_.fill_byte();
  for (int shift = 24; shift >= 0; shift -= 8) out_.put(sum >> shift & 0xffu, 8);
  out_.spill();
  return {stream_.data(), static_cast<std::size_t>(out_.next() - stream_.data())};
}

}  // namespace carom::io::hdf5
