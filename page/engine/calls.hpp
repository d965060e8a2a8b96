// What the page asks for by objects: each function takes a request and gives its answer.
#pragma once

#include <boost/property_tree/ptree.hpp>

#include <string>

#include "files/json.hpp"

namespace carom::page {

/// Keys and values of a JSON object, numbers as they were written.
using Request = boost::property_tree::ptree;
using files::Json;

std::string text_of(const Request&, const char* key);

Json load(const Request&);
Json unload(const Request&);
Json begin_orbit(const Request&);
Json forget_orbit(const Request&);
Json end_of_orbit(const Request&);
Json decisions_of_orbit(const Request&);
Json trust_of_orbit(const Request&);
Json ensemble(const Request&);

}  // namespace carom::page
