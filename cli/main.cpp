#include "cli/commands/program.hpp"

int main(int argc, char** argv) {
  return jostle::run_program(argc, argv, jostle::every_command());
}
