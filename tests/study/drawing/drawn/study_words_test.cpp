#include "study/drawing/drawn/study_words.hpp"

#include <catch2/catch.hpp>

namespace jostle {

TEST_CASE("A caption names bed and realizations, for every container") {
  Study study{.scene = "", .resolved_scene = "", .realizations = 8, .points = {}};
  CHECK(study_words(study).empty());
  StudyPoint point;
  point.n_spheres = 512;
  point.container = PeriodicBox{8, 8};
  study.points.push_back(point);
  CHECK(study_words(study) == "512 spheres in periodic sides, 8 x 8 diameters; 8 realizations");
  point.container = WalledBox{12.5, 8};
  point.n_spheres = 1;
  CHECK(bed_words(point) == "1 sphere in four walls, 12.5 x 8 diameters");
  point.container = Cylinder{19};
  CHECK(bed_words(point) == "1 sphere in a cylinder, 19 diameters wide");
  point.container = Plates{16, 3};
  CHECK(bed_words(point) == "1 sphere in two plates, 16 x 3 diameters");
  point.container = FullyPeriodicBox{5, 6, 7};
  CHECK(bed_words(point) == "1 sphere in a fully periodic box, 5 x 6 x 7 diameters");
}

TEST_CASE("A caption's words name a bed only where a sweep leaves it alone") {
  Study study{.scene = "", .resolved_scene = "", .realizations = 1, .points = {}};
  study.points.resize(3);
  for (StudyPoint& point : study.points) {
    point.n_spheres = 96;
    point.container = PeriodicBox{4, 4};
  }
  CHECK(study_words(study) ==
        "96 spheres in periodic sides, 4 x 4 diameters; 1 realization per sweep point");
  study.points[2].n_spheres = 97;
  CHECK(study_words(study) == "beds that differ with the sweep; 1 realization per sweep point");
}

}  // namespace jostle
