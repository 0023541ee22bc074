"""The reader of real C: preprocessor, parser, and what C means on this chip."""
