"""Chapter 3: what the techniques do by themselves."""
