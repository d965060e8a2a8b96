// The entry point for objects: JSON in, JSON out. What the user can mend is an answer, too.
#include "calls.hpp"

#include <boost/property_tree/json_parser.hpp>

#include <cstdlib>
#include <cstring>
#include <sstream>

#include "carom/base/error.hpp"
#include "carom/files/system_file.hpp"
#include "carom_version.hpp"

namespace carom::page {

std::string text_of(const Request& request, const char* key) {
  return request.get<std::string>(key, "");
}

namespace {

Json systems(const Request&) {
  Json list = Json::array();
  for (const BuiltinSystem& one : builtin_systems()) {
    const std::string_view title = "title = \"";
    const std::size_t from = one.toml.find(title);
    const std::size_t begin = from == one.toml.npos ? from : from + title.size();
    list.push(Json::object()
                  .set("name", one.name)
                  .set("title", from == one.toml.npos
                                    ? one.name
                                    : one.toml.substr(begin, one.toml.find('"', begin) - begin)));
  }
  return Json::object().set("systems", std::move(list));
}

Json toml(const Request& request) {
  const std::string name = text_of(request, "name");
  for (const BuiltinSystem& one : builtin_systems())
    if (one.name == name) return Json::object().set("toml", one.toml);
  load_system(name + (name.find('/') == name.npos ? "" : ".toml"));  // says what there is
  throw InputError("unknown system '" + name + "'");
}

Json version_of(const Request&) {
  return Json::object().set("version", carom::version).set("compiler", carom::compiler);
}

Json answer(const char* text) {
  static constexpr std::pair<const char*, Json (*)(const Request&)> calls[] = {
      {"systems", systems},
      {"toml", toml},
      {"load", load},
      {"unload", unload},
      {"orbit", begin_orbit},
      {"forget", forget_orbit},
      {"ended", end_of_orbit},
      {"decisions", decisions_of_orbit},
      {"trust", trust_of_orbit},
      {"ensemble", ensemble},
      {"version", version_of}};
  std::istringstream in(text);
  Request request;
  boost::property_tree::read_json(in, request);
  const std::string what = text_of(request, "do");
  for (const auto& [name, call] : calls)
    if (what == name) return call(request);
  throw InputError("the page's engine has no call '" + what + "'");
}

Json answer_or_error(const char* text) {
  Json error = Json::object();
  try {
    return answer(text);
  } catch (const InputError& fault) {
    error.set("error", fault.what());
    if (fault.place().line > 0) error.set("line", fault.place().line);
    if (fault.place().column > 0) error.set("column", fault.place().column);
  } catch (const std::bad_alloc&) {
    error.set("error", "out of memory");
  } catch (const std::exception& fault) {
    error.set("error", std::string("internal error, please report it: ") + fault.what());
  }
  return error;
}

}  // namespace
}  // namespace carom::page

extern "C" {

/// The answer to a request; carom_free gives its memory back.
char* carom_call(const char* request) {
  return ::strdup(carom::page::answer_or_error(request).text().c_str());
}
void carom_free(char* answer) { std::free(answer); }
}
