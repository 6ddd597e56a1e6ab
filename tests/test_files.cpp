#include "tests/test_files.hpp"

namespace jostle {

std::string test_data(const std::string& name) {
  return SOURCE_ROOT "/tests/data/" + name;
}

std::string source_file(const std::string& name) {
  return SOURCE_ROOT "/" + name;
}

}  // namespace jostle
