"""The laws that come with contactlab: a package for each published model."""
