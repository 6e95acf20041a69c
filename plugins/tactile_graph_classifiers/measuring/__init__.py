"""What can be measured of an object on the pad."""
