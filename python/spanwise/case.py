"""A case file: bridge, vehicle and crossing in TOML."""
