//! Verification, regression, stress and error messages; the tests are in `tests/tests`.
