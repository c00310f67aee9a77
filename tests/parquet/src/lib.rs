//! Results that the program writes as Parquet, read back by another implementation of the format: see the tests.
