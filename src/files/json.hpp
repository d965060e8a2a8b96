// A JSON value to be printed: objects keep the order in which keys were added.
#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace carom::files {

/// Numbers print as the shortest text that reads back as the same double. What no double holds
/// (infinities, integers beyond 2^53) prints as a string, NaN as null.
class Json {
 public:
  Json() = default;                                                  ///< null
  Json(bool value) : text_(value ? "true" : "false") {}              // NOLINT: values convert
  Json(double value);                                                // NOLINT
  Json(std::string_view value);                                      // NOLINT
  Json(const std::string& value) : Json(std::string_view(value)) {}  // NOLINT
  Json(const char* value) : Json(std::string_view(value)) {}         // NOLINT
  template <std::integral Integer>
  requires(!std::same_as<Integer, bool>) Json(Integer value) {  // NOLINT
    if constexpr (std::signed_integral<Integer>)
      set_integer(value < 0, value < 0 ? 0 - static_cast<std::uint64_t>(value)
                                       : static_cast<std::uint64_t>(value));
    else
      set_integer(false, value);
  }

  static Json object() { return Json(Kind::object); }
  static Json array() { return Json(Kind::array); }

  /// Adds a key to an object.
  Json& set(std::string_view key, Json value);
  /// Adds the keys of another object.
  Json& add(const Json& object);
  /// Adds an element to an array.
  Json& push(Json value);

  /// The value of a key, of an array's element ("0", from the end "-1"), or of a path of both:
  /// "survival.-1.p"; null if there is none.
  const Json* find(std::string_view path) const;
  std::optional<double> number() const;       ///< of a number, or of one that is kept as a text
  std::optional<std::string> string() const;  ///< of a text
  bool is_true() const { return kind_ == Kind::scalar && text_ == "true"; }

  /// One key of the outermost object a line, one element of its arrays of objects a line.
  std::string text() const;

 private:
  enum class Kind { scalar, object, array };
  explicit Json(Kind kind) : kind_(kind) {}
  void set_integer(bool negative, std::uint64_t size);
  void print(std::string& out, int depth) const;
  bool holds_objects() const;

  Kind kind_ = Kind::scalar;
  std::string text_ = "null";
  std::vector<std::pair<std::string, Json>> members_;  // of an object; keys are empty in arrays
};

}  // namespace carom::files
