"""numbers_test.py's search of texts for numbers that are not finite, over all of its other scenes."""

import unittest

from numbers_test import QUICK, SCENES, Texts, add_tests


class AllTexts(Texts):
    pass


add_tests(AllTexts, [name for name in SCENES if name not in QUICK])
del Texts  # without a test of its own


if __name__ == "__main__":
    unittest.main()
