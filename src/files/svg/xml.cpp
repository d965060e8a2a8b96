#include "files/svg/xml.hpp"

#include <algorithm>

namespace carom::files {
namespace {

constexpr std::size_t deepest = 256;  // of elements in each other
constexpr std::size_t most_attributes = 1000;

bool space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool of_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == ':' ||
         c == '_' || c == '-' || c == '.' || static_cast<unsigned char>(c) >= 0x80;
}

std::string utf8(unsigned long number) {
  std::string text;
  const auto byte = [&](unsigned long bits) { text += static_cast<char>(bits); };
  if (number < 0x80) {
    byte(number);
  } else if (number < 0x800) {
    byte(0xc0 | number >> 6);
  } else if (number < 0x10000) {
    byte(0xe0 | number >> 12);
    byte(0x80 | (number >> 6 & 0x3f));
  } else {
    byte(0xf0 | number >> 18);
    byte(0x80 | (number >> 12 & 0x3f));
    byte(0x80 | (number >> 6 & 0x3f));
  }
  if (number >= 0x80) byte(0x80 | (number & 0x3f));
  return text;
}

/// The character of "amp", "#65", "#x41"; "" where there is none.
std::string character(std::string_view reference) {
  static constexpr std::pair<const char*, const char*> names[] = {
      {"amp", "&"}, {"lt", "<"}, {"gt", ">"}, {"quot", "\""}, {"apos", "'"}};
  for (const auto& [name, value] : names)
    if (reference == name) return value;
  if (!reference.starts_with('#') || reference.size() > 8) return "";
  const bool hexadecimal = reference.starts_with("#x");
  reference.remove_prefix(hexadecimal ? 2 : 1);
  unsigned long number = 0;
  for (const char c : reference) {
    const unsigned long digit =
        c >= '0' && c <= '9'                  ? static_cast<unsigned>(c - '0')
        : hexadecimal && c >= 'a' && c <= 'f' ? static_cast<unsigned>(c - 'a' + 10)
        : hexadecimal && c >= 'A' && c <= 'F' ? static_cast<unsigned>(c - 'A' + 10)
                                              : 99U;
    if (digit == 99U) return "";
    number = number * (hexadecimal ? 16 : 10) + digit;
  }
  const bool surrogate = number >= 0xd800 && number <= 0xdfff;
  return number == 0 || number > 0x10ffff || surrogate ? "" : utf8(number);
}

}  // namespace

Place Locator::at(std::size_t offset) const {
  if (offset < offset_) {
    offset_ = 0;
    line_ = column_ = 1;
  }
  for (; offset_ < offset && offset_ < text_.size(); ++offset_) {
    const char c = text_[offset_];
    if (c == '\n') {
      ++line_;
      column_ = 1;
    } else if ((static_cast<unsigned char>(c) & 0xc0) != 0x80) {
      ++column_;
    }
  }
  return {file_, line_, column_, ""};
}

const XmlAttribute* XmlTag::find(std::string_view attribute) const {
  for (const XmlAttribute& a : attributes)
    if (a.name == attribute) return &a;
  return nullptr;
}

std::string decoded(const XmlAttribute& attribute, const Locator& locator) {
  std::string text;
  const std::string_view value = attribute.value;
  for (std::size_t at = 0; at < value.size();) {
    const std::size_t next = std::min(value.find('&', at), value.size());
    text += value.substr(at, next - at);
    if (next == value.size()) break;
    const std::size_t end = std::min(value.find(';', next), value.size());
    const std::string found = character(value.substr(next + 1, end - next - 1));
    if (found.empty())
      throw InputError(locator.at(attribute.offset + next), "'&' begins no known character",
                       "&amp;, &lt;, &gt;, &quot;, &apos; or a number as in &#65;");
    text += found;
    at = end + 1;
  }
  return text;
}

XmlReader::XmlReader(std::string_view text, const Locator& locator)
    : text_(text), locator_(locator) {
  if (begins("\xEF\xBB\xBF")) at_ = 3;
}

void XmlReader::fail(std::size_t at, const std::string& problem,
                     const std::string& expected) const {
  throw InputError(locator_.at(at), problem, expected);
}

void XmlReader::skip_spaces() {
  while (at_ < text_.size() && space(text_[at_])) ++at_;
}

void XmlReader::skip_past(std::string_view end, const char* what) {
  const std::size_t found = text_.find(end, at_);
  if (found == std::string_view::npos)
    fail(at_, std::string(what) + " does not end", "'" + std::string(end) + "'");
  at_ = found + end.size();
}

// Old drawings declare their entities between brackets. What is declared is not used.
void XmlReader::skip_doctype() {
  const std::size_t start = at_;
  int brackets = 0;
  for (char quote = 0; at_ < text_.size(); ++at_) {
    const char c = text_[at_];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (begins("<!--")) {
      skip_past("-->", "the comment");
      --at_;
    } else if (c == '[') {
      ++brackets;
    } else if (c == ']') {
      --brackets;
    } else if (c == '>' && brackets <= 0) {
      ++at_;
      return;
    }
  }
  fail(start, "the declaration <!DOCTYPE does not end", "'>'");
}

std::string_view XmlReader::name(const char* of) {
  const std::size_t begin = at_;
  while (at_ < text_.size() && of_name(text_[at_])) ++at_;
  if (at_ == begin) fail(at_, "the name of " + std::string(of) + " is missing", "a letter");
  return text_.substr(begin, at_ - begin);
}

void XmlReader::attribute(XmlTag& tag) {
  XmlAttribute one;
  const std::size_t begin = at_;
  one.name = name("an attribute");
  if (tag.find(one.name) != nullptr)
    fail(begin, "the attribute '" + std::string(one.name) + "' is given twice", "one of each");
  if (tag.attributes.size() == most_attributes)
    fail(begin, "too many attributes", "at most " + std::to_string(most_attributes));
  skip_spaces();
  if (!begins("=")) fail(at_, "the attribute '" + std::string(one.name) + "' has no value", "'='");
  ++at_;
  skip_spaces();
  const char quote = at_ < text_.size() ? text_[at_] : ' ';
  if (quote != '"' && quote != '\'')
    fail(at_, "the value of '" + std::string(one.name) + "' is not in quotes", "'\"'");
  one.offset = ++at_;
  const std::size_t end = text_.find(quote, at_);
  if (end == std::string_view::npos)
    fail(one.offset - 1, "the value of '" + std::string(one.name) + "' does not end",
         std::string(1, quote));
  one.value = text_.substr(at_, end - at_);
  at_ = end + 1;
  tag.attributes.push_back(one);
}

// Is each element closed where it should be?
void XmlReader::nest(const XmlTag& tag) {
  const std::string shown =
      "<" + std::string(tag.closes && !tag.opens ? "/" : "") + std::string(tag.name) + ">";
  if (tag.opens && open_.empty() && rooted_)
    fail(tag.offset, shown + " follows the end of the drawing", "nothing after it");
  rooted_ = true;
  if (tag.opens && !tag.closes) {
    if (open_.size() == deepest)
      fail(tag.offset, "elements are nested too deeply",
           "at most " + std::to_string(deepest) + " levels");
    open_.push_back(tag.name);
  } else if (!tag.opens) {
    if (open_.empty() || open_.back() != tag.name)
      fail(tag.offset, shown + " closes what is not open",
           open_.empty() ? "nothing after the end" : "</" + std::string(open_.back()) + ">");
    open_.pop_back();
  }
}

bool XmlReader::next(XmlTag& tag) {
  for (;;) {
    at_ = std::min(text_.find('<', at_), text_.size());
    if (at_ == text_.size()) {
      if (!open_.empty())
        fail(at_, "the file ends within <" + std::string(open_.back()) + ">",
             "</" + std::string(open_.back()) + ">");
      if (!rooted_) fail(0, "the file is no drawing", "an SVG file, which begins with <svg");
      return false;
    }
    if (begins("<!--")) {
      skip_past("-->", "the comment");
    } else if (begins("<![CDATA[")) {
      skip_past("]]>", "the text");
    } else if (begins("<?")) {
      skip_past("?>", "the instruction");
    } else if (begins("<!")) {
      skip_doctype();
    } else {
      break;
    }
  }
  tag = {};
  tag.offset = at_++;
  if (begins("/")) {
    ++at_;
    tag.closes = true;
  } else {
    tag.opens = true;
  }
  tag.name = name("an element");
  for (;;) {
    const std::size_t before = at_;
    skip_spaces();
    if (begins(">")) {
      ++at_;
      break;
    }
    if (tag.opens && begins("/>")) {
      at_ += 2;
      tag.closes = true;
      break;
    }
    if (at_ == text_.size())
      fail(tag.offset, "the tag <" + std::string(tag.name) + " does not end", "'>'");
    if (before == at_ || !tag.opens)
      fail(at_, "an unexpected character in the tag <" + std::string(tag.name), "'>'");
    attribute(tag);
  }
  nest(tag);
  if (tag.name.starts_with("svg:")) tag.name.remove_prefix(4);
  return true;
}

}  // namespace carom::files
