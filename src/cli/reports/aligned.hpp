// Numbers and tables of the reports: digits as errors allow, lines that fit a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace carom::cli {

/// Characters of a line. Prose may be longer, tables are not.
inline constexpr std::size_t line_width = 80;

/// How numbers of one size and error are written: as 0.0123, or as 1.23e-05 where the size is below
/// 1e-3 or from 1e6 on.
struct Rounding {
  bool scientific = false;
  int decimals = 6;  ///< digits after the point of a number without exponent
  std::string operator()(double) const;
};
/// The last digit is the second one of `spread`, a standard error; six digits of `size` where the
/// spread is not positive.
Rounding rounding_of(double size, double spread);

/// "0.16993 +- 0.00031".
std::string with_error(double value, double error);

/// A share in per cent with this many digits, all of those before the point: "0.031", "12", "100".
std::string in_percent(double share, int digits = 2);

/// Times with six digits, or as many as tell them apart.
std::vector<std::string> times_text(const std::vector<double>& times);

/// "12.3 ns", "45.6 ms", "7.89 s".
std::string short_duration(double seconds);

/// A column: its header, in several lines if it holds '\n', and a cell for each row.
struct Column {
  std::string header;
  std::vector<std::string> cells;
  bool left = false;    ///< aligned on the left
  bool joined = false;  ///< stays beside the column before it
};
/// Lines of right-aligned columns, two blanks before each.
std::string aligned(const std::vector<Column>&);
/// The same in lines that fit a screen: columns that do not go beside follow in further tables,
/// each with the first column.
std::string fitted(const std::vector<Column>&);
/// "low .. high", padded so that the dots of all rows are below each other.
std::vector<std::string> ranges(const std::vector<std::string>& low,
                                const std::vector<std::string>& high);
/// Prose in lines that fit, broken at blanks; the further lines begin with `indent`.
std::string folded(const std::string& line, const std::string& indent = "",
                   std::size_t width = line_width);
/// The lines of a text.
std::vector<std::string> lines_of(const std::string& text);
/// Length of the longest line; characters of UTF-8 count as one.
std::size_t width_of(const std::string& text);

/// Of `all` rows every k-th from the last one backwards, at most `most` of them: their indices.
std::vector<std::size_t> every_kth(std::size_t all, std::size_t most);

}  // namespace carom::cli
