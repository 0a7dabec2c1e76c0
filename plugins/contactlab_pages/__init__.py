"""Pages of HTML that stand alone: one file each, nothing fetched from anywhere."""
