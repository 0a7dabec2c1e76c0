"""What happens: materials, bodies, scenes, and what the paper knows of them in closed form."""
