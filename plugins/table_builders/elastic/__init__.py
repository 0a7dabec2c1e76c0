"""The table of the elastic rebound: its cuts and cells, exact impacts, and its errors."""
