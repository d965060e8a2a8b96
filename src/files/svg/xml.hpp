// The tags of an XML text one after the other, as far as drawings need it: no entity is expanded,
// so that none can explode, and every attribute knows its place.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "carom/base/error.hpp"

namespace carom::files {

/// Lines and columns of a text; columns count characters. Quick where places are asked for in
/// their order.
class Locator {
 public:
  Locator(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}
  Place at(std::size_t offset) const;

 private:
  std::string_view text_;
  std::string file_;
  mutable std::size_t offset_ = 0;  ///< of what was asked last
  mutable int line_ = 1, column_ = 1;
};

/// As it is written, between the quotes.
struct XmlAttribute {
  std::string_view name, value;
  std::size_t offset = 0;  ///< of the value
};

struct XmlTag {
  std::string_view name;
  std::vector<XmlAttribute> attributes;
  bool opens = false, closes = false;  ///< <a>, </a>; both: <a/>
  std::size_t offset = 0;

  const XmlAttribute* find(std::string_view attribute) const;
};

class XmlReader {
 public:
  XmlReader(std::string_view text, const Locator& locator);
  /// The next tag; false after the last. Faults of the form are an InputError.
  bool next(XmlTag&);

 private:
  [[noreturn]] void fail(std::size_t at, const std::string& problem,
                         const std::string& expected) const;
  bool begins(std::string_view word) const { return text_.substr(at_).starts_with(word); }
  void skip_past(std::string_view end, const char* what);
  void skip_doctype();
  void skip_spaces();
  std::string_view name(const char* of);
  void attribute(XmlTag&);
  void nest(const XmlTag&);

  std::string_view text_;
  const Locator& locator_;
  std::size_t at_ = 0;
  std::vector<std::string_view> open_;
  bool rooted_ = false;
};

/// An attribute's text with its characters in place of &amp; and the like.
std::string decoded(const XmlAttribute&, const Locator&);

}  // namespace carom::files
