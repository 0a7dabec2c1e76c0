"""Studies of many runs, as data; figures and commands draw and print them."""
