"""Studies made of many runs: data only, nothing is drawn here."""
