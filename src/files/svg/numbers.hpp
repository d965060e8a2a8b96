// Numbers in the attributes of a drawing, exact.
#pragma once

#include <gmpxx.h>

#include <cstddef>
#include <string>
#include <string_view>

#include "carom/base/exact_number.hpp"
#include "files/svg/xml.hpp"

namespace carom::files {

/// A drawing's numbers are decimals, and what is computed from them is exact, except for turns.
using Rational = mpq_class;

/// Reads an attribute from its start to its end.
class Scanner {
 public:
  Scanner(const XmlAttribute& attribute, const Locator& locator)
      : text_(attribute.value), offset_(attribute.offset), locator_(locator) {}

  /// Spaces; and one comma.
  void skip_spaces();
  void skip_separator();
  bool at_end() const { return at_ == text_.size(); }
  /// The character at the place, 0 at the end; `take` also passes it.
  char peek() const { return at_end() ? '\0' : text_[at_]; }
  bool take(char c);
  /// Does a number begin here?
  bool at_number() const;
  /// A decimal as "-1.5e-3"; `what`: of what, for the message.
  Rational number(const char* what);
  /// 0 or 1, which the next number may follow without a gap.
  bool flag();
  /// Letters: a unit or a name; maybe none.
  std::string_view word();
  /// A number with a unit that is not relative: px if none is given.
  Rational length(const char* what);

  /// The most digits behind the point so far.
  long decimals() const { return decimals_; }
  std::size_t offset() const { return offset_ + at_; }
  Place place() const { return locator_.at(offset()); }
  [[noreturn]] void fail(const std::string& problem, const std::string& expected) const;

 private:
  std::string_view text_;
  std::size_t offset_, at_ = 0;
  const Locator& locator_;
  long decimals_ = 0;
};

/// The nearest double.
double nearest(const Rational&);
/// As a system file has it: a decimal, a ratio, or, where these are long, the nearest double.
ExactNumber written(const Rational&, const Place&);
/// Its root, exactly: "sqrt(2)".
ExactNumber written_root(const Rational&, const Place&);

}  // namespace carom::files
