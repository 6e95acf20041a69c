"""What a restored image and its line field cost: potentials, and their sum over all cliques."""
