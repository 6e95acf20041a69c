"""One contact for each object, touching or torn apart by voids."""
