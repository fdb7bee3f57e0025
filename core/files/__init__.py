"""Files on disk: atomic writes, and the cache kept between runs."""
