#include "files/hdf5/exact_sums.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>

#include "carom/files/ensembles.hpp"
#include "files/checkpoint/ensemble_columns.hpp"

namespace carom::files {

using hdf5::Description;
using hdf5::Handle;

namespace {
using Digits = std::array<std::int64_t, ExactSum::digits>;
constexpr std::int64_t every = 0xffffffff;  ///< a digit whose bits are all set
}  // namespace

void write_sums(const Handle& group, const char* name, const std::vector<const ExactSum*>& sums,
                Description description, const std::string& file) {
  std::vector<Digits> states;
  for (const ExactSum* sum : sums) states.push_back(sum->state());
  std::size_t first = ExactSum::digits, end = 0;
  // Above the last digit of a negative sum all others are 2^32 - 1, and the highest is -1: together
  // they are a -1 after its last digit.
  for (const Digits& digits : states) {
    const bool negative = digits.back() < 0;
    const std::int64_t above = negative ? every : 0;
    for (std::size_t i = 0; i < digits.size(); ++i) {
      if (digits[i] != 0) first = std::min(first, i);
      if (i + 1 < digits.size() ? digits[i] != above : digits[i] < -1 || digits[i] > 0)
        end = std::max(end, std::min<std::size_t>(i + (negative ? 2 : 1), digits.size()));
    }
    if (negative) end = std::max(end, first + 1);
  }
  first = std::min(first, end);
  std::vector<std::int64_t> column;
  for (const Digits& digits : states) {
    column.insert(column.end(), digits.begin() + static_cast<std::ptrdiff_t>(first),
                  digits.begin() + static_cast<std::ptrdiff_t>(end));
    if (digits.back() < 0 && end < digits.size()) column.back() = -1;
  }
  hdf5::write_column(group.get(), name, std::span(std::as_const(column)), description, file);
  const Handle dataset = hdf5::open_column(group.get(), name, file);
  hdf5::write_attribute(dataset.get(), "first", static_cast<std::int64_t>(first), file);
  hdf5::write_attribute(dataset.get(), "digits", static_cast<std::int64_t>(end - first), file);
}

std::vector<ExactSum> read_sums(const Handle& group, const std::string& path, const char* name,
                                std::size_t count, const std::string& file) {
  const auto column = hdf5::read_column<std::int64_t>(group.get(), name, file);
  const Handle dataset = hdf5::open_column(group.get(), name, file);
  const auto first =
      static_cast<std::uint64_t>(hdf5::read_attribute<std::int64_t>(dataset.get(), "first", file));
  const auto each =
      static_cast<std::uint64_t>(hdf5::read_attribute<std::int64_t>(dataset.get(), "digits", file));
  if (first > ExactSum::digits || each > ExactSum::digits - first || column.size() != each * count)
    damaged(file, fmt::format("'/{}/{}' has lost digits", path, name));
  std::vector<ExactSum> sums;
  for (std::size_t i = 0; i < count; ++i) {
    Digits digits{};
    std::copy_n(column.begin() + static_cast<std::ptrdiff_t>(i * each), each,
                digits.begin() + static_cast<std::ptrdiff_t>(first));
    if (const std::size_t top = first + each;
        each > 0 && top < digits.size() && digits[top - 1] == -1) {
      std::fill(digits.begin() + static_cast<std::ptrdiff_t>(top - 1), digits.end() - 1, every);
      digits.back() = -1;
    }
    sums.push_back(ExactSum::from_state(digits));
  }
  return sums;
}

}  // namespace carom::files
