// A program outside the project: pours a packing with the installed library and prints <Z>.
#include <cstdio>
#include <jostle/engine.hpp>

int main() {
  jostle::RandomStream random(jostle::stream_key(1, 0, 0, jostle::Purpose::start));
  const jostle::Packing packing = jostle::make_start(
      jostle::SteepestDescentPour{}, jostle::PeriodicBox{.width_x = 6, .width_y = 6}, 300, random);
  std::printf("%.17g\n", jostle::mean_height(packing));
}
