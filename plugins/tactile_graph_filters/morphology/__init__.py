"""Masks changed cell by cell: erosion, dilation and what is made of them."""
