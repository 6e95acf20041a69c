"""Which known object it is.

Known objects are those of the classifiers' database, and sizes are stated as a simulated scene's
are: the two families that are read here.
"""
