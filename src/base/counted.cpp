#include "counted.hpp"

#include <cstddef>

namespace carom::base {

std::string grouped(std::uint64_t number) {
  std::string digits = std::to_string(number);
  for (std::size_t i = digits.size(); i > 3; i -= 3) digits.insert(i - 3, 1, ' ');
  return digits;
}

std::string noun_for(std::uint64_t number, std::string_view noun) {
  if (number == 1) return std::string(noun);
  const auto but = [&](std::size_t letters) {
    return std::string(noun.substr(0, noun.size() - letters));
  };
  if (noun.ends_with("y")) return but(1) + "ies";
  if (noun.ends_with("um")) return but(2) + "a";
  return but(0) + (noun.ends_with("s") || noun.ends_with("ch") ? "es" : "s");
}

std::string counted(std::uint64_t number, std::string_view noun) {
  return grouped(number) + " " + noun_for(number, noun);
}

}  // namespace carom::base
